"""Represent joints with a wide range relative to a reference that moves with one example.

Rotation vectors relative to one fixed rotation fail near half a rotation from it. There the
vectors of two similar rotations may point in opposite directions, and their mean resembles
neither. For such joints the reference is the rotation of the center example at the same time
(Grassia 1998, section 3.4: move the singularity away from where the joint is).
"""

from collections.abc import Sequence

import numpy as np
import scipy
from numpy.typing import NDArray

from ..arrays import Array
from ..rotations import (
    IDENTITY,
    inverse,
    multiply,
    normalize,
    rotation_vector_from_quaternion,
    unroll,
)
from .curves import MAX_FRAME_ROTATION_RAD, sample_curves, unwrap_rotation_vectors

MAX_REFERENCE_ANGLE_RAD = 2.0
"""Angle from the fixed reference, in radians, beyond which a joint gets a moving reference.
Half and twice are no better (`make sensitivity`)."""
REFERENCE_SMOOTHING_S = 0.05
"""Standard deviation in seconds of the Gaussian that smooths moving references. Half and twice
are no better (`make sensitivity`)."""


def split_moving_references(
    joints: Array,
    reference_rotations: Array,
    rotations: Sequence[Array],
    times: Array,
    center: int,
    sigma: float,
    is_loop: bool,
) -> tuple[Array, Array, Array | None]:
    """Express wide-ranging joints relative to the center's smoothed rotation at each sample.

    Parameters
    ----------
    joints : shape (n_examples, n_samples, n_joints, 3)
        Rotation vectors relative to `reference_rotations`.
    reference_rotations : shape (n_joints, 4)
    rotations : of each example, shape (n_frames, n_joints, 4)
        Local rotations without heading.
    times : shape (n_examples, n_samples), frames
        Frame of each example at each sample.
    center : int
    sigma : float, frames
        Standard deviation of the Gaussian that smooths the center's rotations.
    is_loop : bool
        Whether the rotations continue at the other end.

    Returns
    -------
    joints, reference_rotations
        Unchanged except for wide-ranging joints, which are relative to the moving references.
    moving_references : shape (n_samples, n_joints, 4), or None
        Rotations before the reference rotation; the identity for other joints. None if no joint
        needs one. A joint that flips within a frame in the center never gets one, since
        no other example can be expressed relative to it.
    """
    is_wide = np.linalg.norm(joints, axis=-1).max(axis=(0, 1)) > MAX_REFERENCE_ANGLE_RAD
    wide = np.flatnonzero(is_wide & ~_find_flips(rotations[center]))
    if not len(wide):
        return joints, reference_rotations, None
    sampled = np.stack([
        normalize(sample_curves(unroll(example[:, wide]), example_times))
        for example, example_times in zip(rotations, times, strict=True)
    ])
    moving_references = np.tile(IDENTITY, (*joints.shape[1:3], 1))
    moving_references[:, wide] = _smooth_rotations(unroll(sampled[center]), sigma, is_loop)
    vectors = rotation_vector_from_quaternion(
        multiply(inverse(moving_references[:, wide]), sampled)
    )
    joints, reference_rotations = joints.copy(), reference_rotations.copy()
    joints[:, :, wide] = np.stack([unwrap_rotation_vectors(example) for example in vectors])
    reference_rotations[wide] = IDENTITY
    return joints, reference_rotations, moving_references


def _find_flips(rotations: Array) -> NDArray[np.bool_]:
    """Return which joints, of (n_frames, n_joints, 4), rotate implausibly far in a frame."""
    steps = multiply(inverse(rotations[:-1]), rotations[1:])
    angles = np.linalg.norm(rotation_vector_from_quaternion(steps), axis=-1)
    return np.asarray((angles > MAX_FRAME_ROTATION_RAD).any(axis=0))


def _smooth_rotations(rotations: Array, sigma: float, is_loop: bool) -> Array:
    """Return smoothed rotations, shape (n_samples, n_wide, 4), of an unrolled input."""
    n = len(rotations)
    n_padding = min(int(4.0 * sigma) + 1, n - 1)
    if is_loop:
        before, after = rotations[n - 1 - n_padding : n - 1], rotations[1 : n_padding + 1]
    else:
        before = np.repeat(rotations[:1], n_padding, axis=0)
        after = np.repeat(rotations[-1:], n_padding, axis=0)
    before = _match_signs(before, rotations[0], before[-1])
    after = _match_signs(after, rotations[-1], after[0])
    # It reflects ends; smooth_gaussian repeats them.
    smooth = scipy.ndimage.gaussian_filter1d(
        np.concatenate([before, rotations, after]), sigma, axis=0
    )
    return normalize(smooth[n_padding : n_padding + n])


def _match_signs(rotations: Array, reference: Array, neighbor: Array) -> Array:
    """Choose the quaternion signs of a segment so that `neighbor` matches `reference`."""
    signs = np.where((reference * neighbor).sum(axis=-1, keepdims=True) < 0.0, -1.0, 1.0)
    return np.asarray(signs * rotations)
