"""Let somebody look on: each pose as soon as it is found."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..body import BodyModel
from .fit_quality import FitQuality

Array = NDArray[np.float64]


class FoundPose(NamedTuple):
    """One frame of a body that is being tracked; later ones of the same frame are better."""

    body: BodyModel
    frame: int
    pose: Array
    """Shape (36,), camera frame."""
    quality: FitQuality


OnPose = Callable[[FoundPose], None]
"""Called with each pose that is found, in the order of solving: frames come again."""


def unobserved(found: FoundPose) -> None:
    """The `OnPose` of scripts and tests: nobody looks on."""


def shifted(on_pose: OnPose, first: int) -> OnPose:
    """Return an `OnPose` for a callee whose frame 0 is the caller's frame `first`."""

    def tell(found: FoundPose) -> None:
        on_pose(found._replace(frame=first + found.frame))

    return tell
