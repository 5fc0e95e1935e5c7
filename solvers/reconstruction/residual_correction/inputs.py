"""Inputs of the residual prior: smoothed, normalized poses of mean body size."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import JointRecording, Tracks
from ...motion.humanoid import (
    ADULT_BONE_LENGTHS_M,
    N_JOINTS,
    PARENTS,
    NormalizedPostures,
    estimate_bone_lengths,
    normalize_postures,
    posture_positions,
    rotate_about_vertical,
)
from ...signals import fill_gaps, smooth_gaussian

NEIGHBORHOODS = tuple(
    tuple(
        [joint]
        + [child for child in range(N_JOINTS) if PARENTS[child] == joint]
        + ([PARENTS[joint]] if PARENTS[joint] >= 0 else [])
    )
    for joint in range(N_JOINTS)
)
"""Each joint with its parent and children [ZH14, section 5.2.1]."""
N_NEIGHBORHOOD_FEATURES = 3 * max(len(joints) for joints in NEIGHBORHOODS)


@dataclass(frozen=True, eq=False)
class SmoothedPostures:
    """A recording as input of the residual prior.

    Attributes
    ----------
    positions : shape (n_frames, 20, 3), meters, world
        Smoothed and without gaps; joints that are never observed are NaN.
    normalized : NormalizedPostures
        The same without heading and position.
    features : shape (n_frames, 20, 3)
        The same for a body of mean size; NaN where `normalized` is.
    frame_rate : float, hertz
    """

    positions: Array
    normalized: NormalizedPostures
    features: Array
    frame_rate: float

    def rotate_to_world(self, offsets: Array) -> Array:
        """Rotate offsets of these frames from body to world axes, (n_frames, n, 3)."""
        return rotate_about_vertical(offsets, self.normalized.headings)


def smooth_postures(
    recording: JointRecording | Tracks,
    seconds: float,
    weights: Array | None = None,
    *,
    causal: bool = False,
) -> SmoothedPostures:
    """Smooth a recording with a Gaussian of `seconds`, fill gaps, and normalize it.

    `weights`, (n_frames, 20), are 0 to 1. If `causal`, a frame depends on no later one, except
    for the actor's size.
    """
    positions = fill_gaps(posture_positions(recording), causal=causal)
    observed = np.isfinite(positions).all(axis=(0, 2))
    rate = recording.frame_rate
    positions[:, observed] = smooth_gaussian(
        positions[:, observed], seconds * rate, causal=causal
    )
    normalized = normalize_postures(positions, rate, weights, causal=causal)
    length = estimate_bone_lengths(positions).sum()
    if length == 0.0:
        raise InvalidMotionError(
            "All joints are at one position. Choose a recording of a tracked actor."
        )
    features = normalized.postures * ADULT_BONE_LENGTHS_M.sum() / length
    return SmoothedPostures(positions, normalized, features, rate)


def fill_missing(features: Array, default: Array) -> Array:
    """Replace joints that are never observed by the mean posture, shape (20, 3)."""
    return np.where(np.isfinite(features), features, default)


def neighborhood_features(features: Array, joint: int) -> Array:
    """Return features of a joint's neighborhood, shape (n_frames, 15), padded with 0."""
    selected = features[:, list(NEIGHBORHOODS[joint])].reshape(len(features), -1)
    padded = np.zeros((len(features), N_NEIGHBORHOOD_FEATURES))
    padded[:, : selected.shape[1]] = selected
    return padded
