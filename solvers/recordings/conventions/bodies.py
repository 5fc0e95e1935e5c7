"""Select one body of several in view of a camera, and mark its gaps."""

from collections import Counter
from collections.abc import Hashable, Mapping, Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Body = TypeVar("Body", bound=Hashable)


def longest_observed_body(frames: Sequence[Mapping[Body, object]]) -> Body:
    """Return the body that is in most frames; the first one of a tie.

    Raises ValueError if there is none.
    """
    counts = Counter(body for frame in frames for body in frame)
    return max(counts, key=lambda body: counts[body])


def stack_body_frames(
    body: Body, frames: Sequence[Mapping[Body, NDArray[np.float64]]]
) -> NDArray[np.float64]:
    """Stack the values of one body; NaN in the frames without it."""
    shape = next(frame[body].shape for frame in frames if body in frame)
    missing = np.full(shape, np.nan)
    return np.stack([frame.get(body, missing) for frame in frames])
