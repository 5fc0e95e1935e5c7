"""Settings of the button Import, named as those of Blender's BVH importer."""

from dataclasses import dataclass, fields
from typing import NamedTuple

from ...solvers.recordings import (
    CameraOrientation,
    DepthSettings,
    FloorPlacementSettings,
    ReadingSettings,
)
from ...solvers.settings import Choice, setting
from ..scene.scene_rate import FrameRate


class ImportTarget(Choice):
    """Type of object that joints become."""

    ARMATURE = "armature", "Create an armature; each joint becomes a bone"
    OBJECT = (
        "object",
        "Create an empty for each joint; keeps every measured position",
        "Empties",
    )


class Rotation(Choice):
    """Rotation mode of the bones."""

    QUATERNION = "quaternion", "Rotate bones by quaternions, without gimbal lock"
    XYZ = "euler (XYZ)", "Rotate bones by Euler angles in XYZ order", "XYZ Euler"
    XZY = "euler (XZY)", "Rotate bones by Euler angles in XZY order", "XZY Euler"
    YXZ = "euler (YXZ)", "Rotate bones by Euler angles in YXZ order", "YXZ Euler"
    YZX = "euler (YZX)", "Rotate bones by Euler angles in YZX order", "YZX Euler"
    ZXY = "euler (ZXY)", "Rotate bones by Euler angles in ZXY order", "ZXY Euler"
    ZYX = "euler (ZYX)", "Rotate bones by Euler angles in ZYX order", "ZYX Euler"


@dataclass(frozen=True, kw_only=True)
class ImportChoices(FloorPlacementSettings, ReadingSettings):
    """Settings of the import of recordings."""

    target: ImportTarget = setting(
        ImportTarget.ARMATURE,
        "Create bones or empties for depth-camera joints; markers always become empties",
    )
    body: str = setting(
        "",
        "Name or number of the body to import, or all; empty for the person in most frames",
        label="Body",
    )
    global_scale: float = setting(
        1.0,
        "Scale the recording by this value; 1 leaves it in meters",
        minimum=1e-4,
        maximum=1e6,
        label="Scale",
    )
    rotate_mode: Rotation = setting(
        Rotation.QUATERNION, "Rotation mode of the bones", label="Rotation"
    )
    keep_meshes: bool = setting(
        False,
        "Keep the skinned meshes of FBX, glTF and USD files, without materials",
        label="Keep Meshes",
    )
    frame_start: int = setting(
        1,
        "First frame of the animation",
        minimum=-1_000_000,
        maximum=1_000_000,
        label="Start Frame",
    )
    frame_rate: FrameRate = setting(
        FrameRate.AUTO,
        "Choose how to handle different frame rates of recording and scene",
        label="Frame Rate",
    )
    update_scene_duration: bool = setting(
        False,
        "Extend the scene to the end of the recording; never shortens it",
        label="Extend Scene",
    )
    focal_length: float = setting(
        0.0,
        "Focal length in pixels; higher makes the actor narrower; 0 reads it from the file",
        minimum=0.0,
        maximum=100_000.0,
    )
    focal_length_y: float = setting(
        0.0,
        "Vertical focal length, if different; higher makes the actor shorter; 0 reads the file",
        minimum=0.0,
        maximum=100_000.0,
        label="Focal Length Y",
    )
    center_x: float = setting(
        0.0,
        "Column where the camera axis meets the image; 0 reads the file or uses the middle",
        minimum=0.0,
        maximum=100_000.0,
        label="Center X",
    )
    center_y: float = setting(
        0.0,
        "Row where the camera axis meets the image; 0 reads the file or uses the middle",
        minimum=0.0,
        maximum=100_000.0,
        label="Center Y",
    )
    held: CameraOrientation = setting(
        CameraOrientation.KNOWN,
        "Set how the depth camera was held",
        label="Camera Orientation",
    )
    mirrored: bool = setting(
        False,
        "Treat the depth images as mirrored: the actor's right hand is on the right",
    )

    @property
    def reading(self) -> ReadingSettings:
        """Conventions that the files may not state."""
        names = [item.name for item in fields(ReadingSettings)]
        return ReadingSettings(**{name: getattr(self, name) for name in names})

    @property
    def depth(self) -> DepthSettings:
        """Settings for depth images."""
        return DepthSettings(
            scale=self.unit.meters or 0.0,
            fx=self.focal_length,
            fy=self.focal_length_y,
            cx=self.center_x,
            cy=self.center_y,
            held=self.held,
            mirrored=self.mirrored,
        )


class ImportBundle(NamedTuple):
    """Settings of the button."""

    choices: ImportChoices
