"""Settings of the button Reconstruct, in addition to those of the solvers."""

from dataclasses import dataclass, fields
from typing import NamedTuple

from ...solvers.denoising import PlantSettings
from ...solvers.reconstruction import ReconstructSettings
from ...solvers.settings import Choice, Settings, setting
from ..actions.armature_write import Output
from ..actions.frames import FrameRange


class Postures(Choice):
    """Source of the postures of natural bodies."""

    SHIPPED = "shipped", "Use the poses that come with Mocap Assist", "Built-In"
    EXAMPLES = (
        "examples",
        "Use the poses of clean takes of the same kind of motion",
        "From Examples",
    )
    LEARNED = (
        "learned file",
        "Use the poses of a file that learn-postures has written",
        "From File",
    )
    LIBRARY = (
        "library",
        "Use the poses of the most similar clips of the motion library",
        "From Library",
    )


@dataclass(frozen=True, kw_only=True)
class ReconstructChoices(Settings):
    """Scope, pose library and output of Reconstruct."""

    postures: Postures = setting(
        Postures.SHIPPED,
        "Source of the clean poses that missing joints are rebuilt from",
        label="Poses",
    )
    examples: str = setting(
        "",
        "Clean actions of this file, or recordings and folders on disk, separated by"
        " semicolons",
    )
    postures_file: str = setting(
        "", "Pose file that learn-postures has written (.npz)", label="Pose File"
    )
    residuals_file: str = setting(
        "",
        "Error model of your sensor from learn-residuals (.npz); empty for the built-in"
        " Kinect v2",
        label="Sensor Error File",
    )
    frame_range: FrameRange = setting(FrameRange.ACTION, "Frames of the action to change")
    plant_feet: bool = setting(
        True, "Keep planted feet from sliding by moving legs and hips slightly"
    )
    result_as: Output = setting(
        Output.ACTION,
        "Assign the result as a new action, or put it on a new NLA track",
        label="Output",
    )


class ReconstructBundle(NamedTuple):
    """Settings of the button."""

    choices: ReconstructChoices
    rebuilding: ReconstructSettings
    planting: PlantSettings


FINISHING_SETTINGS = ("result_as", "plant_feet", *(item.name for item in fields(PlantSettings)))
"""Names of the settings that can be changed without solving again."""
