"""Gaps bridged the plainest way: places along straight lines, rotations along the short way."""

import numpy as np
from numpy.typing import NDArray

from ..rotations import IDENTITY, slerp

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


def fill_gaps(values: Array, known: Flags | None = None, *, ahead: bool = True) -> Array:
    """Bridge the gaps of each point along straight lines; before and after all known, hold.

    Parameters
    ----------
    values : shape (n_frames, ..., n)
        Points over time; NaN: not known.
    known : shape (n_frames, ...), optional
        Which of them to believe, where not all that are finite.
    ahead : bool
        Whether it is known where a gap leads to. If not, hold what was known last; before the
        first that is known, that.

    Returns
    -------
    NDArray, same shape
        What is known stays as it is. A point that is never known is NaN throughout.
    """
    told = np.isfinite(values).all(axis=-1)
    if known is not None:
        told &= known
    result = np.array(values, dtype=np.float64)
    if told.all():
        return result
    flat = result.reshape(len(values), -1, values.shape[-1])
    told = told.reshape(len(values), -1)
    frames = np.arange(len(values))
    for point in np.flatnonzero(~told.all(axis=0)):
        here = told[:, point]
        if not here.any():
            flat[:, point] = np.nan
            continue
        if not ahead:
            last = np.maximum.accumulate(np.where(here, frames, here.argmax()))
            flat[:, point] = flat[last, point]
            continue
        for axis in range(values.shape[-1]):
            flat[~here, point, axis] = np.interp(
                frames[~here], frames[here], flat[here, point, axis]
            )
    return result


def fill_rotation_gaps(rotations: Array) -> Array:
    """Turn each joint evenly from the last known rotation to the next; hold at the ends.

    Parameters
    ----------
    rotations : shape (n_frames, n_joints, 4)
        Unit quaternions w x y z; NaN: not known.

    Returns
    -------
    NDArray, same shape
        What is known stays as it is. A joint that is never known is in its rest pose.
    """
    result = np.array(rotations, dtype=np.float64)
    told = np.isfinite(result).all(axis=-1)
    frames = np.arange(len(result))
    for joint in np.flatnonzero(~told.all(axis=0)):
        here = np.flatnonzero(told[:, joint])
        gap = frames[~told[:, joint]]
        if not len(here):
            result[:, joint] = IDENTITY
            continue
        after = np.searchsorted(here, gap).clip(max=len(here) - 1)
        before = (np.searchsorted(here, gap) - 1).clip(min=0)
        start, stop = here[before], here[after]
        share = (gap - start) / np.maximum(stop - start, 1)
        result[gap, joint] = slerp(
            result[start, joint], result[stop, joint], share.clip(0.0, 1.0)
        )
    return result
