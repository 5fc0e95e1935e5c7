"""Check that recordings of several cameras are not one recording twice."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from ...depth_scene import DepthRecording
from ...errors import InvalidMotionError

_N_COMPARED = 5
"""Number of images that are compared. It bounds the run time; two images of different cameras
differ in every frame by the noise of the sensors."""


def check_different(recordings: Sequence[DepthRecording]) -> None:
    """Raise InvalidMotionError if two recordings have the same images.

    The same images would fit each other perfectly, as those of two cameras at one place.
    """
    for first, second in combinations(range(len(recordings)), 2):
        if _is_same(recordings[first], recordings[second]):
            raise InvalidMotionError(
                f"Cameras {first + 1} and {second + 1} have the same images. Choose recordings"
                " of different cameras."
            )


def _is_same(first: DepthRecording, second: DepthRecording) -> bool:
    if first.n_frames != second.n_frames:
        return False
    frames = np.linspace(0, first.n_frames - 1, _N_COMPARED).round().astype(int)
    return all(
        np.array_equal(first.frame(frame), second.frame(frame)) for frame in frames.tolist()
    )
