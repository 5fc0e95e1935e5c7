"""Fill gaps: positions by linear interpolation, rotations by slerp."""

import numpy as np

from ..arrays import Array, Flags
from ..rotations import IDENTITY, slerp


def fill_gaps(values: Array, known: Flags | None = None, *, causal: bool = False) -> Array:
    """Fill the gaps of each point by linear interpolation; hold the ends.

    Parameters
    ----------
    values : shape (n_frames, ..., n)
        Points over time; NaN: missing.
    known : shape (n_frames, ...), optional
        Valid mask: False treats a finite value as missing too.
    causal : bool
        False: interpolate up to the value after the gap. True: use no later frame, but hold the
        last valid value; before the first valid value, hold that.

    Returns
    -------
    NDArray, same shape
        Valid values are unchanged. A point that is missing in all frames is NaN throughout.
    """
    valid = np.isfinite(values).all(axis=-1)
    if known is not None:
        valid &= known
    result = np.array(values, dtype=np.float64)
    if valid.all():
        return result
    flat = result.reshape(len(values), -1, values.shape[-1])
    valid = valid.reshape(len(values), -1)
    frames = np.arange(len(values))
    for point in np.flatnonzero(~valid.all(axis=0)):
        valid_frames = valid[:, point]
        if not valid_frames.any():
            flat[:, point] = np.nan
            continue
        if causal:
            last_valid = np.maximum.accumulate(
                np.where(valid_frames, frames, valid_frames.argmax())
            )
            flat[:, point] = flat[last_valid, point]
            continue
        for axis in range(values.shape[-1]):
            flat[~valid_frames, point, axis] = np.interp(
                frames[~valid_frames], frames[valid_frames], flat[valid_frames, point, axis]
            )
    return result


def fill_rotation_gaps(rotations: Array) -> Array:
    """Fill the gaps of each joint by slerp between the valid rotations; hold the ends.

    Parameters
    ----------
    rotations : shape (n_frames, n_joints, 4)
        Unit quaternions w x y z; NaN: missing.

    Returns
    -------
    NDArray, same shape
        Valid rotations are unchanged. A joint that is missing in all frames gets the identity.
    """
    result = np.array(rotations, dtype=np.float64)
    valid = np.isfinite(result).all(axis=-1)
    frames = np.arange(len(result))
    for joint in np.flatnonzero(~valid.all(axis=0)):
        valid_frames = np.flatnonzero(valid[:, joint])
        gap = frames[~valid[:, joint]]
        if not len(valid_frames):
            result[:, joint] = IDENTITY
            continue
        after = np.searchsorted(valid_frames, gap).clip(max=len(valid_frames) - 1)
        before = (np.searchsorted(valid_frames, gap) - 1).clip(min=0)
        start, stop = valid_frames[before], valid_frames[after]
        fraction = (gap - start) / np.maximum(stop - start, 1)
        result[gap, joint] = slerp(
            result[start, joint], result[stop, joint], fraction.clip(0.0, 1.0)
        )
    return result
