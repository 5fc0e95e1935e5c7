"""What recordings of depth leave open, and whoever reads them may know."""

from dataclasses import dataclass
from enum import Enum

from ...depth_scene import Camera
from ...settings import Settings, setting


class Held(Enum):
    """How the camera was held when it recorded."""

    KNOWN = "known"
    """As the file says; upright if it does not."""
    UPRIGHT = "upright"
    LEFT = "left"
    """Turned left: the top of the picture is what was at the left."""
    RIGHT = "right"
    UPSIDE_DOWN = "upside down"


@dataclass(frozen=True, kw_only=True)
class DepthSettings(Settings):
    """How pictures of depth are to be understood; 0 leaves a number to the file."""

    scale: float = setting(
        0.0, "Metres in one unit of a pixel: 0.001 for millimetres; 0 takes the file's word",
        unit="m", minimum=0.0, maximum=10.0,
    )  # fmt: skip
    fx: float = setting(
        0.0, "Focal length across the picture; more makes the actor narrower; 0 takes the"
        " file's word", unit="pixels", minimum=0.0, maximum=1e5,
    )  # fmt: skip
    fy: float = setting(
        0.0, "Focal length up the picture; 0 takes the one across", unit="pixels", minimum=0.0,
        maximum=1e5,
    )  # fmt: skip
    cx: float = setting(
        0.0, "Column that the camera's axis meets; 0 takes the file's word, or the middle",
        unit="pixels", minimum=0.0, maximum=1e5,
    )  # fmt: skip
    cy: float = setting(
        0.0, "Row that the camera's axis meets; 0 takes the file's word, or the middle",
        unit="pixels", minimum=0.0, maximum=1e5,
    )  # fmt: skip
    width: int = setting(
        0, "Columns of a picture in raw frames; 0 takes a Kinect's", unit="pixels", minimum=0,
        maximum=4096, advanced=True,
    )  # fmt: skip
    height: int = setting(
        0, "Rows of a picture in raw frames; 0 takes a Kinect's", unit="pixels", minimum=0,
        maximum=4096, advanced=True,
    )  # fmt: skip
    frame_rate: float = setting(
        0.0, "Pictures per second; 0 takes the file's word, or 30", unit="Hz", minimum=0.0,
        maximum=10_000.0,
    )  # fmt: skip
    held: Held = setting(
        Held.KNOWN, "How the camera was held, as a telephone often is on its side"
    )
    mirrored: bool = setting(
        False, "The pictures show the actor's right hand on the right, as a mirror does"
    )
    least_confidence: int = setting(
        1, "Confidence below which a reading is left out, where it was recorded: 0 low, 1"
        " medium, 2 high", minimum=0, maximum=2, advanced=True,
    )  # fmt: skip

    def camera(self, width: int, height: int, told: Camera | None = None) -> Camera | None:
        """Return the camera of pictures of this size; None where nobody tells its focal length.

        What is given counts more than what a file has `told`.
        """
        middle = (width - 1) / 2.0, (height - 1) / 2.0
        if told is not None:
            usual = told.fx, self.fx or told.fy, told.cx, told.cy
        elif self.fx:
            usual = self.fx, self.fx, *middle
        else:
            return None
        given = self.fx, self.fy, self.cx, self.cy
        fx, fy, cx, cy = (one or other for one, other in zip(given, usual, strict=True))
        return Camera(fx, fy, cx, cy, width, height)


DEFAULT_DEPTH_SETTINGS = DepthSettings()
