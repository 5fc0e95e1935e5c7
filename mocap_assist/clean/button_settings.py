"""Settings of the button Clean, in addition to those of the solvers."""

from dataclasses import dataclass, fields
from typing import NamedTuple

from ...solvers.denoising import PART_STRENGTHS, DenoiseSettings, PlantSettings
from ...solvers.settings import Choice, Settings, setting
from ..actions.armature_write import Output
from ..actions.frames import FrameRange
from ..runtime.selection import Bones


class Prior(Choice):
    """Source of the patterns of clean motion."""

    TAKE = (
        "this take",
        "Learn natural motion from this take alone; needs no other data",
        "From This Take",
    )
    EXAMPLES = "examples", "Learn from clean takes of the same kind of motion", "From Examples"
    LEARNED = "learned file", "Use a motion model that Learn has written to a file", "From File"
    LIBRARY = (
        "library",
        "Learn from the most similar clips of the motion library",
        "From Library",
    )


class Limits(Choice):
    """Limits of joint rotations."""

    NONE = "none", "Do not limit the recorded joint rotations"
    CONSTRAINTS = (
        "constraints",
        "Keep joints within the Limit Rotation constraints of their bones",
        "From Constraints",
    )
    EXAMPLES = (
        "examples",
        "Keep joints within the rotations that the examples show",
        "From Examples",
    )


class CleanOutput(Choice):
    """Output of Clean."""

    ACTION = Output.ACTION.value, Output.ACTION.help, Output.ACTION.label
    NLA_TRACK = Output.NLA_TRACK.value, Output.NLA_TRACK.help, Output.NLA_TRACK.label
    DELTA_LAYER = (
        "delta layer",
        "Add the change as an NLA track above the original, with an influence to dial",
    )


@dataclass(frozen=True, kw_only=True)
class CleanChoices(Settings):
    """Scope, motion model and output of Clean."""

    bones: Bones = setting(
        Bones.ALL,
        "Change all bones or the selected ones; planting feet also moves legs and hips",
    )
    frame_range: FrameRange = setting(FrameRange.ACTION, "Frames of the action to change")
    prior: Prior = setting(
        Prior.TAKE,
        "Source of the model of natural motion",
        label="Motion Model",
    )
    examples: str = setting(
        "",
        "Clean actions of this file or recordings on disk, separated by semicolons; any rig"
        " works",
    )
    learned_file: str = setting("", "Motion model that Learn has written")
    unswap: bool = setting(
        True,
        "Fix swapped marker labels before cleaning, where all markers are cleaned",
        label="Fix Swapped Labels",
    )
    plant_feet: bool = setting(
        True, "Keep planted feet from sliding by moving legs and hips slightly"
    )
    keyed_strength: bool = setting(
        True,
        "Where Strength or a body part has keys in the scene, use their value at each frame",
        label="Use Keys",
    )
    joint_limits: Limits = setting(
        Limits.NONE,
        "Keep joint rotations within soft limits",
    )
    result_as: CleanOutput = setting(
        CleanOutput.ACTION,
        "Assign the result as a new action, or put it or its change on an NLA track",
        label="Output",
    )


class CleanBundle(NamedTuple):
    """Settings of the button."""

    choices: CleanChoices
    denoising: DenoiseSettings
    planting: PlantSettings


FINISHING_SETTINGS = (
    "strength",
    *PART_STRENGTHS.values(),
    "keyed_strength",
    "bones",
    "result_as",
    "plant_feet",
    *(item.name for item in fields(PlantSettings)),
)
"""Names of the settings that can be changed without solving again."""
