"""Find gaps of a densely keyed bone: there it was not observed."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from .frames import MAX_RECORDED_STEP_FRAMES

MAX_KEY_SPACING_RATIO = 1.5
"""Distance between neighbors, relative to the median one, that is no gap. By definition between
1, no gap, and 2, one missing key."""
MIN_GAP_FRACTION = 0.25
"""Distance of a frame from the nearest key, as a fraction of the median one, from which it is
in a gap. By definition half of that from the middle of two keys: a frame closer by shows a key
whose time was rounded."""

MAX_EXPORTED_SPACING_RATIO = 3.5
"""The same where an exporter may have removed keys. By definition between two missing keys,
whose values interpolation gives, and three. Blender's FBX exporter leaves up to 3 degrees
across two."""


def unobserved_frames(
    channels: Sequence[Array],
    frames: Array,
    step: float | None = None,
    *,
    redundant_change: float = 0.0,
    holds_ends: bool = False,
) -> NDArray[np.bool_]:
    """Return the frames at which a bone was not captured, shape (n_frames,).

    A recorded take has keys on every frame; where *all* channels of a bone have none, before
    the first and after the last key too, the sensor had lost it. No gap is seen in curves that
    are keyed by hand, which are meant to be interpolated, nor where the values on both sides of
    the hole differ by no more than `redundant_change`: exporters remove such keys.

    Parameters
    ----------
    channels : arrays of shape (n_keys, 2)
        Frame and value of each key of each animated channel of one bone.
    frames : shape (n_frames,)
    step : float
        Frames from one sample to the next, where the action is known to be a recording: then
        even few or widely spaced keys count as captured.
    redundant_change : float
        In the unit of the channels; above 0, one or two missing keys are no gap either.
    holds_ends : bool
        Whether frames before the first and after the last key are no gaps: curves of FBX, glTF
        and USD hold their first and last value there.
    """
    gap = np.ones(len(frames), bool)
    held = np.ones(len(frames), bool)
    for keys in channels:
        missing, same = _holes(keys, frames, step, redundant_change)
        gap &= missing
        held &= same
    if holds_ends:
        first, last = (
            limit(limit(keys[:, 0]) for keys in channels if len(keys)) for limit in (min, max)
        )
        gap &= (frames > first) & (frames < last)
    return np.asarray(gap & ~held)


def _holes(
    keys: Array, frames: Array, step: float | None, redundant_change: float
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Frames that lie in a hole of one channel, and those where both sides nearly agree."""
    times, values = keys[:, 0], keys[:, 1]
    spacing = step or (np.median(np.diff(times)) if len(times) > 2 else np.inf)
    if step is None and spacing > MAX_RECORDED_STEP_FRAMES:
        return np.zeros(len(frames), bool), np.zeros(len(frames), bool)
    after = np.searchsorted(times, frames)
    left, right = (after - 1).clip(min=0), after.clip(max=len(times) - 1)
    nearest = np.minimum(np.abs(frames - times[left]), np.abs(frames - times[right]))
    inside = (after > 0) & (after < len(times))
    ratio = MAX_EXPORTED_SPACING_RATIO if redundant_change else MAX_KEY_SPACING_RATIO
    wide = ~inside | (times[right] - times[left] > ratio * spacing)
    missing = wide & (nearest > MIN_GAP_FRACTION * spacing)
    return missing, inside & (np.abs(values[left] - values[right]) <= redundant_change)
