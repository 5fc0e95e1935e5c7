"""Postures as if all actors stood in one place and faced one way [SHJT13, section V-A]."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from ...signals import fill_gaps, smooth_gaussian
from .posture_joints import HIPS, MIRROR_JOINTS, POSTURE_JOINTS

Array = NDArray[np.float64]

LATERAL_JOINTS = tuple(
    tuple(POSTURE_JOINTS.index(name) for name in (f"left{part}", f"right{part}", middle))
    for part, middle in (("UpperLeg", "hips"), ("UpperArm", "chest"))
)
"""Joints on the left and on the right, and one between for where either is not tracked."""
STEADY = 0.1
"""Seconds of the Gaussian that steadies the heading: jitter must not turn the whole body."""
SHORTEST = 0.02
"""Metres. A level line from right to left that is shorter tells no heading."""

AROUND = 1.0
"""Seconds in which most frames must tell one heading, for those against it to be wrong."""
AGREED = 0.3
"""Length of the mean of unit vectors from which on they do: 0 is none, 1 the same."""


@dataclass(frozen=True, eq=False)
class NormalizedPostures:
    """Postures without heading and place.

    Attributes
    ----------
    postures : shape (n_frames, 20, 3), metres
        Relative to the hips; the actor faces -Y, his left is +X. NaN: not tracked.
    places : shape (n_frames, 3), metres
        Where the hips are.
    headings : shape (n_frames,), radians
        Turn about Z that brings a posture back.
    """

    postures: Array
    places: Array
    headings: Array

    def put_back(self, postures: Array) -> Array:
        """Return postures of these frames in the world, same shape."""
        return rotate_about_vertical(postures, self.headings) + self.places[:, None]


def normalize_postures(
    positions: Array, frame_rate: float, weights: Array | None = None, *, ahead: bool = True
) -> NormalizedPostures:
    """Take heading and place out.

    The heading follows the level lines from the right to the left hip and shoulder, and is
    steadied over a tenth of a second.

    Parameters
    ----------
    positions : shape (n_frames, 20, 3), metres
    frame_rate : float, hertz
    weights : shape (n_frames, 20), 0 to 1, optional
        How far each joint is to be trusted.
    ahead : bool
        Whether later frames tell of a heading, and of hips that are lost.
    """
    trust = np.ones(positions.shape[:2]) if weights is None else weights
    places = np.nan_to_num(fill_gaps(positions[:, HIPS], trust[:, HIPS] > 0.0, ahead=ahead))
    left = np.zeros((len(positions), 2))
    for one, other, middle in LATERAL_JOINTS:
        line, sure = _to_the_left(positions, trust, one, other)
        for half in ((one, middle), (middle, other)):
            part, known = _to_the_left(positions, trust, *half)
            lost = ~np.isfinite(line[:, 0])
            line[lost], sure[lost] = 2.0 * part[lost], known[lost]
        left += np.where(np.isfinite(line), line, 0.0) * (1e-3 + sure[:, None])
    told = np.linalg.norm(left, axis=-1) > SHORTEST * 1e-3
    if not told.any():
        left[:], told = (1.0, 0.0), np.ones(len(left), bool)
    unit = left / np.maximum(np.linalg.norm(left, axis=-1, keepdims=True), 1e-9)
    unit = fill_gaps(unit, told, ahead=ahead)
    if ahead:
        unit = fill_gaps(unit, ~_reversed(unit, frame_rate))
    unit = smooth_gaussian(np.nan_to_num(unit), STEADY * frame_rate, ahead=ahead)
    headings = np.arctan2(unit[:, 1], unit[:, 0])
    return NormalizedPostures(
        rotate_about_vertical(positions - places[:, None], -headings), places, headings
    )


def _to_the_left(positions: Array, trust: Array, left: int, right: int) -> tuple[Array, Array]:
    """Return the level way from one joint to another, and how far both are to be trusted."""
    line = (positions[:, left] - positions[:, right])[:, :2]
    return line, np.minimum(trust[:, left], trust[:, right])


def _reversed(unit: Array, frame_rate: float) -> NDArray[np.bool_]:
    """Tell where left points against most of the second around: nobody turns so fast.

    A tracker that exchanges left and right does so. Nothing is told of who spins.
    """
    most = uniform_filter1d(unit, 2 * round(0.5 * AROUND * frame_rate) + 1, axis=0)
    agreed = np.linalg.norm(most, axis=-1) > AGREED
    return np.asarray(agreed & ((unit * most).sum(axis=-1) < 0.0))


def rotate_about_vertical(postures: Array, angles: Array) -> Array:
    """Turn each frame about Z by its angle, in radians."""
    cos, sin = np.cos(angles)[:, None], np.sin(angles)[:, None]
    x, y, z = np.moveaxis(postures, -1, 0)
    return np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=-1)


def mirror_postures(vectors: Array) -> Array:
    """Return vectors of joints without heading, (..., 20, 3), as a mirror shows them."""
    return np.asarray(vectors[..., list(MIRROR_JOINTS), :] * (-1.0, 1.0, 1.0))
