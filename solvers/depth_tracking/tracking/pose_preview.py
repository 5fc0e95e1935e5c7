"""Previews of poses during tracking: a callback per tracked pose."""

from collections.abc import Callable
from typing import NamedTuple

from ...arrays import Array
from ..body import BodyModel
from .fit_quality import FitQuality


class PosePreview(NamedTuple):
    """One frame of a body during tracking; later previews of the same frame supersede it."""

    body: BodyModel
    frame: int
    pose: Array
    """Shape (36,), camera frame."""
    quality: FitQuality


PoseCallback = Callable[[PosePreview], None]
"""Called with each tracked pose, in solving order; frames can repeat."""


def ignore_pose(preview: PosePreview) -> None:
    """Ignore a pose: the default `PoseCallback`."""


def offset_frames(on_pose: PoseCallback, first: int) -> PoseCallback:
    """Return a `PoseCallback` for a callee whose frame 0 is the caller's frame `first`."""

    def callback(preview: PosePreview) -> None:
        on_pose(preview._replace(frame=first + preview.frame))

    return callback
