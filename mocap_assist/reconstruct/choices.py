"""What an animator chooses for Reconstruct, besides the settings of the solvers themselves."""

from dataclasses import dataclass, fields
from enum import Enum
from typing import NamedTuple

from ...solvers.denoising import PlantSettings
from ...solvers.reconstruction import ReconstructSettings
from ...solvers.settings import Settings, setting
from ..actions.armature_write import Output
from ..actions.frames import FrameRange


class Postures(Enum):
    """Where postures of natural bodies come from."""

    SHIPPED = "shipped"
    EXAMPLES = "examples"
    LEARNED = "learned file"
    LIBRARY = "library"


@dataclass(frozen=True, kw_only=True)
class ReconstructChoices(Settings):
    """What is rebuilt, by what, and where the result goes."""

    postures: Postures = setting(
        Postures.SHIPPED,
        "Guess lost joints from the postures that come with Mocap Assist, from clean clips of"
        " the same kind of motion, from a file of postures, or from clips of the library that"
        " are like the take",
    )
    examples: str = setting(
        "",
        "Clean actions of this file, or recordings and folders of them on disk, separated by"
        " semicolons; any rig serves",
    )
    postures_file: str = setting(
        "", "Postures of your own, as learn-postures wrote them (.npz)"
    )
    residuals_file: str = setting(
        "",
        "How your own sensor errs, as learn-residuals wrote it (.npz); without it that of a"
        " Kinect v2 is taken out of recordings of such a one",
        label="Sensor's errors",
    )
    frame_range: FrameRange = setting(
        FrameRange.ACTION, "Change all frames of the action, or only some of them"
    )
    plant_feet: bool = setting(
        True, "Keep standing feet from sliding, by moving legs and hips a little"
    )
    result_as: Output = setting(
        Output.ACTION,
        "Put the result in the place of the action, or on an NLA track of its own",
    )


class ReconstructBundle(NamedTuple):
    """All that the button offers."""

    choices: ReconstructChoices
    rebuilding: ReconstructSettings
    planting: PlantSettings


QUICK = ("result_as", "plant_feet", *(item.name for item in fields(PlantSettings)))
"""Names of the settings that can be changed without solving again."""
