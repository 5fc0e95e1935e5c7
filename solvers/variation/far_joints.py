"""Joints that turn far from their usual rotation, told by how they differ from one example.

Rotation vectors about one fixed rotation are of no use near half a turn from it: there the
vectors of two like rotations may point to opposite sides, and what lies between them is like
neither. Such joints are told about the rotation that the centre's has at the same moment
(Grassia 1998, section 3.4: move the singularity away from where the joint is).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ..rotations import (
    IDENTITY,
    inverse,
    multiply,
    normalize,
    rotation_vector_from_quaternion,
    unroll,
)
from .curve_sampling import sample_curves
from .motion_curves import IMPOSSIBLE, continuous

Array = NDArray[np.float64]

FAR = 2.0
"""Radians from its usual rotation at which a joint is told otherwise."""
CALM = 0.05
"""Seconds over which the rotations are smoothed that joints are told about."""


def tell_far_joints(
    joints: Array,
    usual: Array,
    plain: Sequence[Array],
    times: Array,
    centre: int,
    beside: float,
    is_loop: bool,
) -> tuple[Array, Array, Array | None]:
    """Tell joints that turn far about the centre's rotation at each moment.

    Parameters
    ----------
    joints : shape (n_examples, n_moments, n_joints, 3)
        Rotation vectors about `usual`.
    usual : shape (n_joints, 4)
    plain : of each example, shape (n_frames, n_joints, 4)
        Its rotations, without heading.
    times : shape (n_examples, n_moments), frames
        When each example is at each moment.
    centre : int
    beside : float
        Frames over which the centre's rotations are smoothed.
    is_loop : bool
        Whether they go on at the other end.

    Returns
    -------
    joints, usual
        As before, but for those that turn far: about the carrier.
    carrier : shape (n_moments, n_joints, 4), or None
        What comes before `usual`; the identity for other joints. None where no joint turns far.
        About what jumps within a frame no other example can be told.
    """
    turned = np.linalg.norm(joints, axis=-1).max(axis=(0, 1)) > FAR
    far = np.flatnonzero(turned & ~_flips(plain[centre]))
    if not len(far):
        return joints, usual, None
    seen = np.stack([
        normalize(sample_curves(unroll(one[:, far]), at))
        for one, at in zip(plain, times, strict=True)
    ])
    carrier = np.tile(IDENTITY, (*joints.shape[1:3], 1))
    carrier[:, far] = _calm(unroll(seen[centre]), beside, is_loop)
    told = rotation_vector_from_quaternion(multiply(inverse(carrier[:, far]), seen))
    joints, usual = joints.copy(), usual.copy()
    joints[:, :, far] = np.stack([continuous(one) for one in told])
    usual[far] = IDENTITY
    return joints, usual, carrier


def _flips(rotations: Array) -> NDArray[np.bool_]:
    """Return which joints, of (n_frames, n_joints, 4), turn as none can."""
    steps = multiply(inverse(rotations[:-1]), rotations[1:])
    angles = np.linalg.norm(rotation_vector_from_quaternion(steps), axis=-1)
    return np.asarray((angles > IMPOSSIBLE).any(axis=0))


def _calm(rotations: Array, beside: float, is_loop: bool) -> Array:
    """Return smoothed rotations, shape (n_moments, n_far, 4), unrolled before."""
    n = len(rotations)
    reach = min(int(4.0 * beside) + 1, n - 1)
    if is_loop:
        before, after = rotations[n - 1 - reach : n - 1], rotations[1 : reach + 1]
    else:
        before = np.repeat(rotations[:1], reach, axis=0)
        after = np.repeat(rotations[-1:], reach, axis=0)
    before = _alike(before, rotations[0], before[-1])
    after = _alike(after, rotations[-1], after[0])
    smooth = gaussian_filter1d(np.concatenate([before, rotations, after]), beside, axis=0)
    return normalize(smooth[reach : reach + n])


def _alike(rotations: Array, here: Array, there: Array) -> Array:
    """Choose the signs of rotations whose one end goes on as `here`."""
    sign = np.where((here * there).sum(axis=-1, keepdims=True) < 0.0, -1.0, 1.0)
    return np.asarray(sign * rotations)
