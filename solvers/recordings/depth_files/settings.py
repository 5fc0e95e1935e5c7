"""Settings for values that depth recordings do not store."""

from dataclasses import dataclass
from enum import Enum

from ...depth_scene import Camera
from ...settings import Settings, setting


class Held(Enum):
    """Orientation of the camera during the recording."""

    KNOWN = "known"
    """Orientation from the file; upright if it has none."""
    UPRIGHT = "upright"
    LEFT = "left"
    """Rotated left: the top of the image was at the left."""
    RIGHT = "right"
    UPSIDE_DOWN = "upside down"


@dataclass(frozen=True, kw_only=True)
class DepthSettings(Settings):
    """Interpretation of depth images; 0 uses the value of the file."""

    scale: float = setting(
        0.0, "Metres in one pixel unit: 0.001 for millimetres; 0 uses the value of the file",
        unit="m", minimum=0.0, maximum=10.0,
    )  # fmt: skip
    fx: float = setting(
        0.0, "Horizontal focal length; larger values make the actor narrower; 0 uses the"
        " value of the file", unit="pixels", minimum=0.0, maximum=1e5,
    )  # fmt: skip
    fy: float = setting(
        0.0, "Vertical focal length; 0 uses the horizontal one", unit="pixels", minimum=0.0,
        maximum=1e5,
    )  # fmt: skip
    cx: float = setting(
        0.0, "Column of the principal point; 0 uses the value of the file, or the center",
        unit="pixels", minimum=0.0, maximum=1e5,
    )  # fmt: skip
    cy: float = setting(
        0.0, "Row of the principal point; 0 uses the value of the file, or the center",
        unit="pixels", minimum=0.0, maximum=1e5,
    )  # fmt: skip
    width: int = setting(
        0, "Columns of an image in raw frames; 0 uses those of a Kinect", unit="pixels",
        minimum=0, maximum=4096, advanced=True,
    )  # fmt: skip
    height: int = setting(
        0, "Rows of an image in raw frames; 0 uses those of a Kinect", unit="pixels",
        minimum=0, maximum=4096, advanced=True,
    )  # fmt: skip
    frame_rate: float = setting(
        0.0, "Images per second; 0 uses the value of the file, or 30", unit="Hz", minimum=0.0,
        maximum=10_000.0,
    )  # fmt: skip
    held: Held = setting(
        Held.KNOWN, "Orientation of the camera; phones are often held sideways"
    )
    mirrored: bool = setting(
        False, "The images are mirrored: the right hand of the actor is on the right"
    )
    least_confidence: int = setting(
        1, "Minimum confidence of a depth reading, if the file has it: 0 low, 1"
        " medium, 2 high", minimum=0, maximum=2, advanced=True,
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
