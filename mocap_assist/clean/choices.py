"""What an animator chooses for Clean, besides the settings of the solvers themselves."""

from dataclasses import dataclass, fields
from enum import Enum
from typing import NamedTuple

from ...solvers.denoising import DenoiseSettings, PlantSettings
from ...solvers.settings import Settings, setting
from ..actions.armature_write import Output
from ..actions.frames import FrameRange
from ..runtime.selection import Bones


class Prior(Enum):
    """Where the patterns of clean motion come from."""

    TAKE = "this take"
    EXAMPLES = "examples"
    LEARNED = "learned file"
    LIBRARY = "library"


class Limits(Enum):
    """How far joints may turn."""

    NONE = "none"
    CONSTRAINTS = "constraints"
    EXAMPLES = "examples"


@dataclass(frozen=True, kw_only=True)
class CleanChoices(Settings):
    """What is cleaned, by what, and where the result goes."""

    bones: Bones = setting(
        Bones.ALL,
        "Change all bones, or only the selected ones; all of them guide the estimate. Planting"
        " feet also moves the legs and the hips",
    )
    frame_range: FrameRange = setting(
        FrameRange.ACTION, "Change all frames of the action, or only some of them"
    )
    prior: Prior = setting(
        Prior.TAKE,
        "Learn how this body moves from the take itself, from clean examples of the same kind"
        " of motion, use what was learned before, or let clips be found in the library that are"
        " like the take",
    )
    examples: str = setting(
        "",
        "Clean actions of this file, or recordings on disk, separated by semicolons;"
        " any rig serves",
    )
    learned_file: str = setting("", "File of learned patterns, as written by Learn")
    unswap: bool = setting(
        True,
        "Put swapped and mistaken labels of markers right first, where all markers are cleaned",
    )
    plant_feet: bool = setting(
        True, "Keep standing feet from sliding, by moving legs and hips a little"
    )
    joint_limits: Limits = setting(
        Limits.NONE,
        "Keep joints softly within the Limit Rotation constraints of their bones, or within"
        " what the examples show",
    )
    result_as: Output = setting(
        Output.ACTION,
        "Put the result in the place of the action, or on an NLA track of its own",
    )


class CleanSettings(NamedTuple):
    """All that the button offers."""

    choices: CleanChoices
    denoising: DenoiseSettings
    planting: PlantSettings


QUICK = (
    "strength",
    "bones",
    "result_as",
    "plant_feet",
    *(item.name for item in fields(PlantSettings)),
)
"""Names of the settings that can be changed without solving again."""
