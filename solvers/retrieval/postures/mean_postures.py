"""Estimate missing joints from a normal distribution of postures."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motion.humanoid import (
    ADULT_BONE_LENGTHS_M,
    HALF_LATERAL_JOINTS,
    LATERAL_JOINTS,
    N_JOINTS,
    PARENTS,
    rotate_about_vertical,
    segment_lengths,
)
from ...motion.skeletons import MIN_BONE_M
from ...rotations import RIGID_POINTS
from .clip_postures import ClipPostures

N_COORDINATES = 3 * N_JOINTS
POSITION_NOISE_M = 0.03
"""Standard deviation of a joint position in meters, in addition to the covariance, which guards
clips that hardly move: from x0.001 to x1000 the mean changes by 0.01 %."""
MAX_LENGTH_RATIO = 1.4
"""Maximum ratio by which a path past missing joints is scaled up or down. Half and twice are no
better (`make sensitivity`)."""
MIN_OBSERVED_FRACTION = 0.9
"""Fraction of frames with an observed joint above which it helps to find the heading. It guards
takes whose joints are lost one after the other: at 0.5 no frame may show all such joints."""
N_HEADING_FRAMES = 24
"""Number of frames, evenly spaced, used for the heading. It bounds the run time."""
NEAR_ANGLES = np.radians(np.arange(-75.0, 76.0, 5.0))
"""Candidate headings, radians, if the heading is roughly known. It bounds the run time."""
ALL_ANGLES = np.radians(np.arange(-180.0, 180.0, 5.0))
"""The same, radians, if the heading is unknown: by definition a full turn."""
HEADING_ERROR_RAD = np.radians(20.0)
"""Standard deviation of the heading error of a body with missing joints. It guards an actor who
leans aside while only his trunk is seen: at 40 degrees he is turned to lean forward."""


@dataclass(frozen=True, eq=False)
class PostureDistribution:
    """A normal distribution of postures.

    Attributes
    ----------
    mean, covariance : shapes (60,) and (60, 60), meters
    """

    mean: Array
    covariance: Array

    def fill_gaps(self, postures: ClipPostures) -> ClipPostures:
        """Fill all gaps with the conditional mean of the missing joints.

        A body with missing joints is first rotated to its most probable heading, because its
        hips and shoulders give an unreliable heading.
        """
        if np.isfinite(postures.positions).all():
            return postures
        rotated = self._rotate_to_heading(postures)
        return replace(rotated, positions=self.fill_positions(rotated))

    def fill_positions(self, postures: ClipPostures) -> Array:
        """Return positions without gaps, shape (n_frames, 20, 3); keep the heading.

        A child of a missing joint has its observed position, with the proportions of the actor.
        After a first estimate, the path past the missing joint is scaled to its standard
        length, and the joint is estimated again.
        """
        observed = np.isfinite(postures.positions)
        if observed.all():
            return postures.positions
        estimate = self._conditional_mean(postures.positions)
        return self._conditional_mean(_correct_proportions(estimate, observed.all(axis=-1)))

    def _conditional_mean(self, positions: Array) -> Array:
        """Set missing joints to their conditional mean given the observed joints."""
        flat = positions.reshape(len(positions), -1).copy()
        patterns, labels = np.unique(np.isfinite(flat), axis=0, return_inverse=True)
        for number, observed in enumerate(patterns):
            rows = np.flatnonzero(labels.reshape(-1) == number)
            missing = ~observed
            covariance = self.covariance[
                np.ix_(observed, observed)
            ] + POSITION_NOISE_M**2 * np.eye(observed.sum())
            gain = np.linalg.solve(covariance, self.covariance[np.ix_(observed, missing)])
            deviations = flat[np.ix_(rows, observed)] - self.mean[observed]
            flat[np.ix_(rows, missing)] = self.mean[missing] + deviations @ gain
        return np.asarray(flat.reshape(positions.shape))

    def _rotate_to_heading(self, postures: ClipPostures) -> ClipPostures:
        """Rotate a clip by the angle with the highest likelihood of the observed joints."""
        frequent = (
            np.isfinite(postures.positions).all(axis=-1).mean(axis=0) > MIN_OBSERVED_FRACTION
        )
        if frequent.all() or frequent.sum() < RIGID_POINTS:
            return postures
        observed = postures.positions[:, frequent]
        complete = observed[np.isfinite(observed).all(axis=(1, 2))]
        if not len(complete):
            return postures
        sample = complete[
            np.linspace(0, len(complete) - 1, min(N_HEADING_FRAMES, len(complete))).astype(int)
        ]
        columns = np.repeat(frequent, 3)
        covariance = self.covariance[np.ix_(columns, columns)] + POSITION_NOISE_M**2 * np.eye(
            columns.sum()
        )
        whitening = np.linalg.inv(np.linalg.cholesky(covariance)).T
        angles, prior_costs = NEAR_ANGLES, 0.5 * (NEAR_ANGLES / HEADING_ERROR_RAD) ** 2
        if not _observes_heading(postures):
            angles, prior_costs = ALL_ANGLES, np.zeros(len(ALL_ANGLES))
        candidates = [
            rotate_about_vertical(sample, np.full(len(sample), angle)) for angle in angles
        ]
        deviations = np.reshape(candidates, (len(angles), len(sample), -1)) - self.mean[columns]
        costs = 0.5 * ((deviations @ whitening) ** 2).sum(axis=-1).mean(axis=-1)
        angle = _parabola_minimum(angles, costs + prior_costs)
        return ClipPostures(
            rotate_about_vertical(postures.positions, np.full(postures.n_frames, angle)),
            _rotate_velocity(postures.root_velocity, angle),
            postures.frame_rate,
        )


def _observes_heading(postures: ClipPostures) -> bool:
    """Whether hips or shoulders were observed in any frame, so that the heading is known."""
    observed = np.isfinite(postures.positions).all(axis=-1)
    pairs = (*LATERAL_JOINTS, *HALF_LATERAL_JOINTS)
    return any(observed[:, list(pair)].all(axis=1).any() for pair in pairs)


def _correct_proportions(positions: Array, observed: NDArray[np.bool_]) -> Array:
    """Scale the paths past missing joints to standard lengths; missing joints become NaN.

    Parameters
    ----------
    positions : shape (n_frames, 20, 3), meters
        First estimates for missing joints.
    observed : shape (n_frames, 20)
    """
    lengths = segment_lengths(positions)
    # Last observed ancestor of each joint: old and new position, and path length from there.
    old, new = positions.copy(), positions.copy()
    path, standard = np.zeros(observed.shape), np.zeros(observed.shape)
    for joint in range(1, N_JOINTS):
        above = PARENTS[joint]
        since = (
            path[:, above] + lengths[:, joint],
            standard[:, above] + ADULT_BONE_LENGTHS_M[joint],
        )
        scale = np.clip(
            since[1] / np.maximum(since[0], MIN_BONE_M),
            1.0 / MAX_LENGTH_RATIO,
            MAX_LENGTH_RATIO,
        )
        position = new[:, above] + scale[:, None] * (positions[:, joint] - old[:, above])
        is_observed = observed[:, joint]
        old[:, joint] = np.where(is_observed[:, None], positions[:, joint], old[:, above])
        new[:, joint] = np.where(is_observed[:, None], position, new[:, above])
        path[:, joint], standard[:, joint] = np.where(is_observed, 0.0, since)
    return np.where(observed[..., None], new, np.nan)


def _parabola_minimum(arguments: Array, values: Array) -> float:
    """Return the minimum of the parabola through the smallest of evenly spaced values."""
    best = int(values.argmin())
    if not 0 < best < len(values) - 1:
        return float(arguments[best])
    before, is_observed, after = values[best - 1 : best + 2]
    curvature = max(before - 2.0 * is_observed + after, 1e-9)
    return float(
        arguments[best] + 0.5 * (arguments[1] - arguments[0]) * (before - after) / curvature
    )


def _rotate_velocity(root_velocity: Array, angle: float) -> Array:
    cos, sin = np.cos(angle), np.sin(angle)
    left, backward, *others = root_velocity.T
    return np.stack(
        [cos * left - sin * backward, sin * left + cos * backward, *others], axis=-1
    )


def learn_posture_distribution(clips: Sequence[ClipPostures]) -> PostureDistribution:
    """Learn mean and covariance from clips with gaps; untracked joints have the mean 0."""
    flat = np.concatenate([clip.positions.reshape(clip.n_frames, -1) for clip in clips])
    observed = np.isfinite(flat)
    mean = np.where(observed, flat, 0.0).sum(axis=0) / np.maximum(observed.sum(axis=0), 1)
    deviations = np.where(observed, flat - mean, 0.0)
    counts = observed.astype(np.float64).T @ observed
    eigenvalues, axes = np.linalg.eigh(deviations.T @ deviations / np.maximum(counts, 1.0))
    return PostureDistribution(mean, np.asarray((axes * np.maximum(eigenvalues, 0.0)) @ axes.T))


def is_covariance(matrix: Array) -> bool:
    """Whether a matrix, (n, n) in m², is symmetric and, with the noise, positive definite."""
    return bool(
        np.allclose(matrix, matrix.T)
        and np.linalg.eigvalsh(matrix)[0] > -0.5 * POSITION_NOISE_M**2
    )
