"""What an animator chooses for Import; the words are those of Blender's BVH importer."""

from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

from ...solvers.recordings import DepthSettings, Held
from ...solvers.settings import Settings, setting
from ..scene.scene_rate import FrameRate


class Target(Enum):
    """What joints become."""

    ARMATURE = "armature"
    OBJECT = "object"


class Rotation(Enum):
    """Rotation mode of the bones."""

    QUATERNION = "quaternion"
    XYZ = "euler (XYZ)"
    XZY = "euler (XZY)"
    YXZ = "euler (YXZ)"
    YZX = "euler (YZX)"
    ZXY = "euler (ZXY)"
    ZYX = "euler (ZYX)"


class Unit(Enum):
    """What the lengths of files are measured in."""

    GUESS = "guess"
    METRES = "metres"
    CENTIMETRES = "centimetres"
    MILLIMETRES = "millimetres"

    @property
    def metres(self) -> float | None:
        """Metres in one of these; None for what the file says, or its reader guesses."""
        return METRES.get(self)


METRES = {Unit.METRES: 1.0, Unit.CENTIMETRES: 0.01, Unit.MILLIMETRES: 0.001}


@dataclass(frozen=True, kw_only=True)
class ImportChoices(Settings):
    """How recordings come into the scene."""

    target: Target = setting(
        Target.ARMATURE,
        "Joints of a depth camera become the bones of an armature, or one empty each, which"
        " keeps every measured position. Markers always become empties",
    )
    unit: Unit = setting(
        Unit.GUESS,
        "What the lengths of the files are measured in. Guess takes the file's word or, where"
        " it says nothing, what makes a human body, and tells which that was",
    )
    global_scale: float = setting(
        1.0,
        "Scale the recording by this value; 1 leaves it in true metres",
        minimum=1e-4,
        maximum=1e6,
        label="Scale",
    )
    rotate_mode: Rotation = setting(
        Rotation.QUATERNION, "Rotation mode of the bones", label="Rotation"
    )
    frame_start: int = setting(
        1,
        "Starting frame for the animation",
        minimum=-1_000_000,
        maximum=1_000_000,
        label="Start Frame",
    )
    frame_rate: FrameRate = setting(
        FrameRate.SCALE,
        "Where the recording has another rate than the scene. Scale FPS keeps every sample and"
        " its second, between frames if need be. Resample to Scene FPS keeps the seconds, with"
        " one key on each frame. Update Scene FPS gives the scene the rate of the first"
        " recording. One Sample a Frame lets the recording play faster or slower",
        label="Frame Rate",
    )
    update_scene_duration: bool = setting(
        False,
        "Extend the scene's duration to the recording's (never shortens the scene)",
        label="Update Scene Duration",
    )
    focal_length: float = setting(
        0.0,
        "Of a depth camera, in pixels, where the files do not tell it, as folders of pictures"
        " often do not; more makes the actor narrower. 0 takes the file's word",
        minimum=0.0,
        maximum=100_000.0,
    )
    focal_length_y: float = setting(
        0.0,
        "Vertical focal length of a depth camera, in pixels, if it differs from the horizontal"
        " one; more makes the actor shorter. 0 takes the file's word, or the horizontal one",
        minimum=0.0,
        maximum=100_000.0,
        label="Focal Length Y",
    )
    center_x: float = setting(
        0.0,
        "Column of pixels at which the axis of a depth camera meets the picture. 0 takes the"
        " file's word, or the middle",
        minimum=0.0,
        maximum=100_000.0,
        label="Center X",
    )
    center_y: float = setting(
        0.0,
        "Row of pixels at which the axis of a depth camera meets the picture. 0 takes the"
        " file's word, or the middle",
        minimum=0.0,
        maximum=100_000.0,
        label="Center Y",
    )
    held: Held = setting(
        Held.KNOWN,
        "How the depth camera was held: turned left has the actor's head at the left of the"
        " picture. Known takes the file's word",
        label="Depth Camera",
    )
    mirrored: bool = setting(
        False,
        "The pictures of depth show the actor's right hand on the right, as a mirror does",
    )

    @property
    def depth(self) -> DepthSettings:
        """What this means for pictures of depth."""
        return DepthSettings(
            scale=self.unit.metres or 0.0,
            fx=self.focal_length,
            fy=self.focal_length_y,
            cx=self.center_x,
            cy=self.center_y,
            held=self.held,
            mirrored=self.mirrored,
        )


class ImportSettings(NamedTuple):
    """All that the button offers."""

    choices: ImportChoices
