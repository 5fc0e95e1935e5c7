"""Convert the common time of the examples to the frames of a variant."""

import numpy as np
import scipy

from ..arrays import Array
from ..errors import InvalidMotionError
from ..rotations import normalize, unroll
from .curves import HEIGHT_COLUMN, MotionCurves, sample_curves, sample_linearly

MAX_POSES = 1 << 26
"""Rotations of joints in a variant. It bounds the memory for damaged models, to 2 GB."""


def apply_time_warp(curves: MotionCurves, durations: Array) -> MotionCurves:
    """Return curves at whole frames, where each sample lasts for a given duration.

    Parameters
    ----------
    curves : MotionCurves
    durations : shape (n_samples,), frames

    Raises
    ------
    InvalidMotionError
        The samples last too long.
    """
    steps = (durations[1:] + durations[:-1]) / 2.0
    ends = np.concatenate([[0.0], np.cumsum(steps)])
    if not ends[-1] * curves.joints.shape[1] <= MAX_POSES:
        raise InvalidMotionError(
            f"A variant would have {ends[-1]:.3g} frames; learn the model again from its clips,"
            " or vary timing less."
        )
    n_frames = max(round(ends[-1]), 1) + 1
    ends *= (n_frames - 1) / ends[-1]
    samples = scipy.interpolate.PchipInterpolator(ends, np.arange(len(ends)))(
        np.arange(n_frames)
    )
    times = np.clip(samples, 0.0, len(ends) - 1.0)
    displacements = np.cumsum(curves.root[:, :HEIGHT_COLUMN], axis=0)
    channels = [
        displacements,
        curves.root[:, HEIGHT_COLUMN:],
        curves.joints.reshape(len(displacements), -1),
    ]
    sampled = sample_curves(np.concatenate(channels, axis=1), times)
    root = np.diff(sampled[:, :HEIGHT_COLUMN], axis=0, prepend=sampled[:1, :HEIGHT_COLUMN])
    joints = sampled[:, HEIGHT_COLUMN + 1 :].reshape(n_frames, *curves.joints.shape[1:])
    contact_state = (
        None if curves.contact_state is None else sample_linearly(curves.contact_state, times)
    )
    moving_references = curves.moving_references
    if moving_references is not None:
        moving_references = normalize(sample_curves(unroll(moving_references), times))
    return MotionCurves(
        np.column_stack([root, sampled[:, HEIGHT_COLUMN]]),
        joints,
        contact_state,
        moving_references,
    )
