"""What becomes of a recording that was followed."""

from dataclasses import dataclass

from ...arrays import Array
from ...denoising import Planted
from ...depth_tracking.capturing import Capture
from ...motion import Motion


@dataclass(frozen=True, eq=False)
class FollowedMotion:
    """The motion of a recording that was followed.

    Attributes
    ----------
    motion : Motion
        Z up, without gaps; feet are planted if requested and possible.
    captured : Capture
    planted : Planted or None
    first : int
        Frame of the recording at which the motion begins.
    n_dropped : int
        Number of images that were dropped since then, as newer ones waited.
    delays : shape (n_tracked,), seconds
        From the time of each image's file to its pose. Files that were there before following
        began count from then.
    detection_delays : tuple of int
        Number of frames from each request of a detection to its pose.
    remarks : tuple of str
        Sentences the animator should read.
    """

    motion: Motion
    captured: Capture
    planted: Planted | None
    first: int
    n_dropped: int
    delays: Array
    detection_delays: tuple[int, ...]
    remarks: tuple[str, ...]
