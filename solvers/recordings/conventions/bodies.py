"""Several bodies in view of one camera: which one is meant, and where it is missing."""

from collections import Counter
from collections.abc import Hashable, Mapping, Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Body = TypeVar("Body", bound=Hashable)


def longest_observed_body(frames: Sequence[Mapping[Body, object]]) -> Body:
    """Return the body that is in most frames; of equals, the one that came first.

    Raises ValueError where there is none.
    """
    counts = Counter(body for frame in frames for body in frame)
    return max(counts, key=lambda body: counts[body])


def stack_body_frames(
    body: Body, frames: Sequence[Mapping[Body, NDArray[np.float64]]]
) -> NDArray[np.float64]:
    """Return one body's values, stacked; NaN in the frames without it."""
    shape = next(frame[body].shape for frame in frames if body in frame)
    nothing = np.full(shape, np.nan)
    return np.stack([frame.get(body, nothing) for frame in frames])
