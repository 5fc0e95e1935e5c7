"""Settings of a depth camera that recordings may not state, as animators know them."""

from dataclasses import dataclass

from ...solvers.recordings import CameraOrientation, DepthSettings, Unit
from ...solvers.settings import Settings, setting


@dataclass(frozen=True, kw_only=True)
class DepthCameraChoices(Settings):
    """Lens and orientation of a depth camera."""

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

    def depth_settings(self, unit: Unit, frame_rate: float = 0.0) -> DepthSettings:
        """Return these and the unit of the images; 0 hertz reads the file or uses 30."""
        return DepthSettings(
            scale=unit.meters or 0.0,
            fx=self.focal_length,
            fy=self.focal_length_y,
            cx=self.center_x,
            cy=self.center_y,
            frame_rate=frame_rate,
            held=self.held,
            mirrored=self.mirrored,
        )
