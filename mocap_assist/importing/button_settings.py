"""Settings of the button Import, named as those of Blender's BVH importer."""

from dataclasses import dataclass, fields
from typing import NamedTuple

from ...solvers.recordings import DepthSettings, FloorPlacementSettings, ReadingSettings
from ...solvers.settings import Choice, setting
from ..depth.camera_choices import DepthCameraChoices
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
class ImportChoices(DepthCameraChoices, FloorPlacementSettings, ReadingSettings):
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

    @property
    def reading(self) -> ReadingSettings:
        """Conventions that the files may not state."""
        names = [item.name for item in fields(ReadingSettings)]
        return ReadingSettings(**{name: getattr(self, name) for name in names})

    @property
    def depth(self) -> DepthSettings:
        """Settings for depth images."""
        return self.depth_settings(self.unit)


class ImportBundle(NamedTuple):
    """Settings of the button."""

    choices: ImportChoices
