"""What the animator is shown while a recording is followed."""

from collections.abc import Callable
from typing import NamedTuple

from ...depth_scene import Actor, Camera, DepthImage


class FollowState(NamedTuple):
    """State of following after an image."""

    camera: Camera
    """Of `depth`."""
    depth: DepthImage | None
    """The image, coarse, meters; None if it is left out."""
    actor: Actor | None
    """None before the actor is measured."""
    n_tracked: int
    n_dropped: int
    """Number of images that were dropped since the motion began."""
    delay_s: float
    """From the time of the last tracked image's file to its pose, seconds."""

    @property
    def sentence(self) -> str:
        """Numbers of images and the delay in words."""
        n_tracked, delay_ms, n_dropped = self.n_tracked, 1e3 * self.delay_s, self.n_dropped
        return f"Tracking image {n_tracked}, {delay_ms:.0f} ms behind, {n_dropped} dropped."


StateCallback = Callable[[FollowState], None]


def ignore_state(state: FollowState) -> None:
    """Ignore a state; the default."""
