"""Settings of Retarget and Unbake, in addition to those of the solvers."""

from dataclasses import dataclass
from typing import NamedTuple

from ...solvers.retargeting import RetargetSettings, UnbakeSettings
from ...solvers.settings import Choice, Settings, setting
from ..rigs.control_plan import Limbs


class Takes(Choice):
    """Actions of the source that are retargeted."""

    PLAYED = "played", "Retarget only the current action of the source armature", "Current"
    LISTED = "listed", "Retarget the actions that are selected in the list", "Selected Actions"
    ALL = "all", "Retarget all actions that have keys for bones of the source", "All Matching"


@dataclass(frozen=True, kw_only=True)
class RetargetChoices(Settings):
    """The target, the motions, and how limbs are keyed."""

    target: str = setting("", "Armature that receives the motion")
    takes: Takes = setting(
        Takes.PLAYED,
        "Actions of the source to retarget",
        label="Source Action",
    )
    actions: str = setting("", "Names of the listed actions, separated by semicolons")
    limbs: Limbs = setting(
        Limbs.FK,
        "Controls of arms and legs to key, where the target has FK and IK",
        label="Arms and Legs",
    )
    source_map_file: str = setting(
        "",
        "Bone map of the source; if empty, the list below or the names and rest pose are used",
        label="Source Map",
    )
    target_map_file: str = setting(
        "",
        "Bone map of the target: the bone or control to key for each part",
        label="Target Map",
    )


class RetargetBundle(NamedTuple):
    """Settings of the button."""

    choices: RetargetChoices
    retargeting: RetargetSettings


@dataclass(frozen=True, kw_only=True)
class UnbakeChoices(Settings):
    """Settings of the accuracy of sparse keys."""

    tolerance: float = setting(
        0.01,
        "Largest error of hands, feet and head; higher leaves fewer keys",
        unit="m", minimum=0.0001, maximum=1.0,
    )  # fmt: skip


class UnbakeBundle(NamedTuple):
    """Settings of the button."""

    choices: UnbakeChoices
    unbaking: UnbakeSettings
