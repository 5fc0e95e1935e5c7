"""Normalize the position and heading of postures [SHJT13, section V-A]."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...signals import CausalSmoother, fill_gaps, smooth_gaussian
from ..skeletons import MIN_BONE_M
from .posture_joints import HIPS, MIRROR_JOINTS, POSTURE_JOINTS

LATERAL_JOINTS = tuple(
    (POSTURE_JOINTS.index(f"left{part}"), POSTURE_JOINTS.index(f"right{part}"))
    for part in ("UpperLeg", "UpperArm")
)
"""Left and right joint of hips and of shoulders."""
HALF_LATERAL_JOINTS = tuple(
    (POSTURE_JOINTS.index(left), POSTURE_JOINTS.index(right))
    for left, right in (
        ("leftUpperLeg", "hips"),
        ("hips", "rightUpperLeg"),
        ("leftUpperArm", "chest"),
        ("chest", "rightUpperArm"),
    )
)
"""The same with the joint between them, for frames with no pair of left and right joint. They
are less parallel to the heading: a chest is not in the middle of its shoulders."""
HEADING_SMOOTHING_S = 0.1
"""Standard deviation of the Gaussian that smooths the heading. It guards hips and shoulders
with jitter, which would rotate the complete body (`test_jitter_does_not_rotate_the_body`)."""

REVERSAL_WINDOW_S = 1.0
"""Window over which opposite headings are compared with the mean, to detect swaps. It guards
sensors that swap left and right for some frames
(`test_left_right_swaps_do_not_change_the_heading`)."""
MIN_AGREEMENT = 0.3
"""Length of the mean of unit vectors, a ratio, above which they agree: 0 is random, 1
identical. It guards spinning actors, whose headings have no mean
(`test_heading_of_a_spinning_actor_is_followed`)."""


@dataclass(frozen=True, eq=False)
class NormalizedPostures:
    """Postures with heading and position removed.

    Attributes
    ----------
    postures : shape (n_frames, 20, 3), meters
        Relative to the hips; the actor faces -Y, the actor's left is +X. NaN: missing.
    hip_positions : shape (n_frames, 3), meters
        Positions of the hips.
    headings : shape (n_frames,), radians
        Rotation about Z that restores the heading.
    """

    postures: Array
    hip_positions: Array
    headings: Array

    def to_world(self, postures: Array) -> Array:
        """Return postures of these frames in world space, same shape."""
        return rotate_about_vertical(postures, self.headings) + self.hip_positions[:, None]


def normalize_postures(
    positions: Array, frame_rate: float, weights: Array | None = None, *, causal: bool = False
) -> NormalizedPostures:
    """Remove heading and position from postures.

    The heading is that of the horizontal lines from right to left hip and shoulder, smoothed
    over a tenth of a second.

    Parameters
    ----------
    positions : shape (n_frames, 20, 3), meters
    frame_rate : float, hertz
    weights : shape (n_frames, 20), 0 to 1, optional
        Reliability of each joint.
    causal : bool
        Whether heading and missing hips of a frame depend on no later frame.
    """
    reliability = np.ones(positions.shape[:2]) if weights is None else weights
    hip_positions = np.nan_to_num(
        fill_gaps(positions[:, HIPS], reliability[:, HIPS] > 0.0, causal=causal)
    )
    unit, determined = _lateral_directions(positions, reliability)
    if not determined.any():
        unit[:], determined = (1.0, 0.0), np.ones(len(unit), bool)
    unit = fill_gaps(unit, determined, causal=causal)
    if not causal:
        unit = fill_gaps(unit, ~_is_reversed(unit, frame_rate))
    unit = smooth_gaussian(np.nan_to_num(unit), HEADING_SMOOTHING_S * frame_rate, causal=causal)
    return _without_heading(positions, hip_positions, unit)


class PostureNormalizer:
    """`normalize_postures` without later frames, one frame after another.

    Until hips and a lateral line were observed, the actor is at the origin and faces -Y.

    Parameters
    ----------
    frame_rate : float, hertz
    """

    def __init__(self, frame_rate: float) -> None:
        self._hips, self._lateral = np.zeros((1, 3)), np.array([[1.0, 0.0]])
        self._smoother = CausalSmoother(HEADING_SMOOTHING_S * frame_rate)

    def update(self, positions: Array, reliability: Array) -> NormalizedPostures:
        """Return the normalized posture of the next frame.

        Parameters
        ----------
        positions : shape (1, 20, 3), meters
        reliability : shape (1, 20), 0 to 1
        """
        if np.isfinite(positions[0, HIPS]).all() and reliability[0, HIPS] > 0.0:
            self._hips = positions[:, HIPS]
        lateral, determined = _lateral_directions(positions, reliability)
        if determined.all():
            self._lateral = lateral
        return _without_heading(positions, self._hips, self._smoother.update(self._lateral))


def _lateral_directions(
    positions: Array, reliability: Array
) -> tuple[Array, NDArray[np.bool_]]:
    """Return horizontal directions to the left, (n_frames, 2), and where they are known."""
    lateral = _lateral_lines(positions, reliability, LATERAL_JOINTS)
    missing = ~lateral.any(axis=1)
    lateral[missing] = _lateral_lines(
        positions[missing], reliability[missing], HALF_LATERAL_JOINTS
    )
    lengths = np.linalg.norm(lateral, axis=-1, keepdims=True)
    return lateral / np.maximum(lengths, 1e-9), lengths[:, 0] > MIN_BONE_M * 1e-3


def _without_heading(
    positions: Array, hip_positions: Array, lateral: Array
) -> NormalizedPostures:
    """Remove the heading, given by directions to the left, and the position of the hips."""
    headings = np.arctan2(lateral[:, 1].copy(), lateral[:, 0].copy())
    return NormalizedPostures(
        rotate_about_vertical(positions - hip_positions[:, None], -headings),
        hip_positions,
        headings,
    )


def _lateral_lines(
    positions: Array, reliability: Array, pairs: Sequence[tuple[int, int]]
) -> Array:
    """Return the sum of the horizontal lines from right to left joint, (n_frames, 2).

    Each is weighted by its reliability; missing ones are zero.
    """
    total = np.zeros((len(positions), 2))
    for left, right in pairs:
        line = (positions[:, left] - positions[:, right])[:, :2]
        weight = np.minimum(reliability[:, left], reliability[:, right])
        total += np.where(np.isfinite(line), line, 0.0) * (1e-3 + weight[:, None])
    return total


def _is_reversed(unit: Array, frame_rate: float) -> NDArray[np.bool_]:
    """Return where the heading is opposite to the mean of a second, as in left-right swaps.

    No frame of a spinning actor is returned: its headings have no consistent mean.
    """
    from scipy.ndimage import uniform_filter1d  # slow to import: only when needed

    mean_direction = uniform_filter1d(
        unit, 2 * round(0.5 * REVERSAL_WINDOW_S * frame_rate) + 1, axis=0
    )
    consistent = np.linalg.norm(mean_direction, axis=-1) > MIN_AGREEMENT
    return np.asarray(consistent & ((unit * mean_direction).sum(axis=-1) < 0.0))


def rotate_about_vertical(postures: Array, angles: Array) -> Array:
    """Rotate each frame of (n_frames, n_joints, 3) about Z by its angle, radians."""
    cos, sin = np.cos(angles)[:, None], np.sin(angles)[:, None]
    x, y, z = np.moveaxis(postures, -1, 0)
    return np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=-1)


def mirror_postures(vectors: Array) -> Array:
    """Return the mirror image of joint vectors without heading, shape (..., 20, 3)."""
    return np.asarray(vectors[..., list(MIRROR_JOINTS), :] * (-1.0, 1.0, 1.0))
