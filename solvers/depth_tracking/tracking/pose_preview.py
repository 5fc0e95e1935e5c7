"""Let somebody look on: each pose as soon as it is found."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..body import BodyModel
from .fit_quality import FitQuality

Array = NDArray[np.float64]


class PosePreview(NamedTuple):
    """One frame of a body that is being tracked; later ones of the same frame are better."""

    body: BodyModel
    frame: int
    pose: Array
    """Shape (36,), camera frame."""
    quality: FitQuality


PoseCallback = Callable[[PosePreview], None]
"""Called with each pose that is found, in the order of solving: frames come again."""


def ignore_pose(found: PosePreview) -> None:
    """The `PoseCallback` of scripts and tests: nobody looks on."""


def offset_frames(on_pose: PoseCallback, first: int) -> PoseCallback:
    """Return an `PoseCallback` for a callee whose frame 0 is the caller's frame `first`."""

    def tell(found: PosePreview) -> None:
        on_pose(found._replace(frame=first + found.frame))

    return tell
