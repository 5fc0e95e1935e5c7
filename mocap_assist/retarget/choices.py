"""What an animator chooses for Retarget and Unbake, besides the solvers' own settings."""

from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

from ...solvers.retargeting import RetargetSettings, UnbakeSettings
from ...solvers.settings import Settings, setting
from ..rigs.control_plan import Limbs


class Takes(Enum):
    """Actions of the source that are retargeted."""

    PLAYED = "played"
    LISTED = "listed"
    ALL = "all"


@dataclass(frozen=True, kw_only=True)
class RetargetChoices(Settings):
    """Who gets the motion, which motions, and how limbs are keyed."""

    target: str = setting("", "Name of the armature that is to make the motion")
    takes: Takes = setting(
        Takes.PLAYED,
        "Retarget the action that the armature plays, those that are listed, or all that have"
        " keys for its bones",
    )
    actions: str = setting("", "Names of the listed actions, separated by semicolons")
    limbs: Limbs = setting(
        Limbs.FK,
        "Key the FK or the IK controls of arms and legs, where the target has both; with both,"
        " either can be switched to",
    )
    source_map_file: str = setting(
        "",
        "Preset that says which bone of the source plays which part; without it the list of"
        " bones is used, or bones are found by their names and places",
    )
    target_map_file: str = setting(
        "", "Preset that says which bone of the target is keyed for which part"
    )


class RetargetBundle(NamedTuple):
    """All that the button offers."""

    choices: RetargetChoices
    retargeting: RetargetSettings


@dataclass(frozen=True, kw_only=True)
class UnbakeChoices(Settings):
    """How exact the sparse keys are."""

    tolerance: float = setting(
        0.01,
        "Greatest distance by which hands, feet and head may be off; higher leaves fewer keys",
        unit="m", minimum=0.0001, maximum=1.0,
    )  # fmt: skip


class UnbakeBundle(NamedTuple):
    """All that the button offers."""

    choices: UnbakeChoices
    unbaking: UnbakeSettings
