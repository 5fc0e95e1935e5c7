"""Settings for values that depth recordings do not store."""

from dataclasses import dataclass

from ...depth_scene import Camera
from ...settings import Choice, Settings, setting


class CameraOrientation(Choice):
    """Orientation of the camera during the recording."""

    KNOWN = (
        "known",
        "Read the orientation from the file; upright if it has none",
        "From File",
    )
    """Orientation stored in the file; upright if there is none."""
    UPRIGHT = "upright", "Treat the camera as upright"
    LEFT = (
        "left",
        "Treat the camera as turned left; heads are at the left of the image",
        "Turned Left",
    )
    """Turned left: the left of the scene is at the top of the image."""
    RIGHT = (
        "right",
        "Treat the camera as turned right; heads are at the right of the image",
        "Turned Right",
    )
    UPSIDE_DOWN = "upside down", "Treat the camera as upside down"


@dataclass(frozen=True, kw_only=True)
class DepthSettings(Settings):
    """Interpretation of depth images; 0 uses the value of the file."""

    scale: float = setting(
        0.0, "Meters per pixel unit: 0.001 for millimeters; 0 reads the file",
        unit="m", minimum=0.0, maximum=10.0,
    )  # fmt: skip
    fx: float = setting(
        0.0, "Horizontal focal length; higher makes the actor narrower; 0 reads it from the"
        " file", unit="pixels",
        minimum=0.0, maximum=1e5,
    )  # fmt: skip
    fy: float = setting(
        0.0, "Vertical focal length; 0 uses the horizontal one", unit="pixels", minimum=0.0,
        maximum=1e5,
    )  # fmt: skip
    cx: float = setting(
        0.0,
        "Column where the camera axis meets the image; 0 reads the file or uses the middle",
        unit="pixels", minimum=0.0, maximum=1e5,
    )  # fmt: skip
    cy: float = setting(
        0.0, "Row where the camera axis meets the image; 0 reads the file or uses the middle",
        unit="pixels", minimum=0.0, maximum=1e5,
    )  # fmt: skip
    width: int = setting(
        0, "Image width of raw frames; 0 uses that of a Kinect", unit="pixels", minimum=0,
        maximum=4096, advanced=True,
    )  # fmt: skip
    height: int = setting(
        0, "Image height of raw frames; 0 uses that of a Kinect", unit="pixels", minimum=0,
        maximum=4096, advanced=True,
    )  # fmt: skip
    frame_rate: float = setting(
        0.0, "Images per second; 0 reads the file or uses 30", unit="Hz", minimum=0.0,
        maximum=10_000.0,
    )  # fmt: skip
    held: CameraOrientation = setting(CameraOrientation.KNOWN, "Set how the camera was held")
    mirrored: bool = setting(
        False, "Treat the images as mirrored: the actor's right hand is on the right"
    )
    min_confidence: int = setting(
        1, "Ignore readings of lower recorded confidence: 0 low, 1 medium, 2 high", minimum=0,
        maximum=2, advanced=True, former="least_confidence",
    )  # fmt: skip

    def camera(self, width: int, height: int, stored: Camera | None = None) -> Camera | None:
        """Return the camera of images of this size; None if the focal length is unknown.

        Settings override the camera that was `stored` in the file.
        """
        middle = (width - 1) / 2.0, (height - 1) / 2.0
        if stored is not None:
            default = stored.fx, self.fx or stored.fy, stored.cx, stored.cy
        elif self.fx:
            default = self.fx, self.fx, *middle
        else:
            return None
        given = self.fx, self.fy, self.cx, self.cy
        fx, fy, cx, cy = (
            value or fallback for value, fallback in zip(given, default, strict=True)
        )
        return Camera(fx, fy, cx, cy, width, height)


DEFAULT_DEPTH_SETTINGS = DepthSettings()
