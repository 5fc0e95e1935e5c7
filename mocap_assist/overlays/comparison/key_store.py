"""Keys of whole actions, read once as plain numbers, to look at a few frames at a time."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ....solvers.arrays import Array
from ...actions.bone_channels import Curves, animated_curves
from ...actions.curves import ON_FRAME
from ...blender.compat import Source

Keys = Mapping[tuple[str, int], NDArray[np.float32]]
N_ADJACENT = 16
"""Number of keys on both sides of a gap that show how densely a bone was recorded. It bounds
the memory."""


def read_keys(source: Source) -> Keys:
    """Return frame and value of every key, by channel: shape (n_keys, 2), as Blender has it."""
    return {
        name: each.keys.astype(np.float32) for name, each in animated_curves(*source).items()
    }


def curves_near(source: Source, keys: Keys, frames: Array) -> Curves:
    """Return the F-Curves as they are now, with only the keys that the frames need."""
    curves = animated_curves(*source)
    for name in curves.keys() & keys.keys():
        curves[name].keys = _keys_near(keys[name], frames)
    return curves


def _keys_near(keys: NDArray[np.float32], frames: Array) -> Array:
    """Return the keys on the frames; if a frame has none, its neighboring keys too."""
    times = keys[:, 0]
    edges = np.array([frames[0] - ON_FRAME, frames[-1] + ON_FRAME], np.float32)
    first, last = np.searchsorted(times, edges)
    if last - first != len(frames) or (np.abs(times[first:last] - frames) > ON_FRAME).any():
        first, last = max(first - N_ADJACENT, 0), last + N_ADJACENT
    return keys[first:last].astype(np.float64)
