"""What is measured of variants; definitions in docs/benchmarks/variation.md."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from scipy.spatial.distance import cdist

from solvers.denoising import learn_joint_limits, limit_excess
from solvers.denoising.quality.foot_slide import measure_foot_slide, sole_paths
from solvers.motion import Motion, forward_kinematics, warp
from solvers.motion.humanoid.foot_contacts import detect_contacts
from solvers.rotations.representations import inverse, multiply, rotation_vector_from_quaternion
from solvers.variation.align_examples import ALIGNMENT_RATE_HZ, positions_in_body_frame

from ..shared.clips import every

WINDOW, WINDOW_RATE = 11, 30.0
PAIRS = 60
"""Pairs of variants whose distance is measured: as many as tell the mean."""
BEYOND = np.radians(0.5)
"""Radians beyond a limit that count as passing it."""


class Judge:
    """What variants of these examples are held against."""

    def __init__(self, examples: Sequence[Motion]) -> None:
        self.examples = list(examples)
        self.bodies = [_body(one) for one in examples]
        self.variation, distances = _variation(self.bodies)
        self.nearest = float(np.median(np.nanmin(distances, axis=1)))
        self.windows = [_windows(one) for one in examples]
        gaps = [
            cdist(one, np.concatenate(self.windows[:i] + self.windows[i + 1 :])).min(axis=1)
            for i, one in enumerate(self.windows)
        ]
        self.near = float(np.median(np.concatenate(gaps)))
        self.jerk = float(np.mean([_jerk(one) for one in examples]))
        self.limits = learn_joint_limits(examples)
        self.spectrum = _spectrum(examples)
        self.contacts = contact_figures(examples)

    def contacts_of(
        self, drawn: Sequence[Motion], planted: Sequence[Motion]
    ) -> dict[str, float]:
        """Return figures of feet: of the examples, of variants as drawn and as finished."""
        slides, stands = zip(*map(contact_figures, (drawn, planted)), strict=True)
        return {
            "slide of examples": self.contacts[0],
            "slide drawn": slides[0],
            "slide": slides[1],
            "stands of examples %": 100.0 * self.contacts[1],
            "stands %": 100.0 * stands[1],
            "jerk finished": float(np.mean([_jerk(one) for one in planted])) / self.jerk,
        }

    def figures(self, variants: Sequence[Motion]) -> dict[str, float]:
        """Return all figures of some variants; for copies V is 0 or 1, the jerk 1."""
        bodies = [_body(one) for one in variants]
        windows = np.concatenate([_windows(one) for one in variants])
        covered = [cdist(one, windows).min(axis=1) < self.near for one in self.windows]
        nearest = [min(warp(one, other).cost for other in self.bodies) for one in bodies[:10]]
        beyond = [limit_excess(one, self.limits) for one in variants[:10]]
        return {
            "V": 100.0 * _variation(bodies)[0],
            "V ratio": _variation(bodies)[0] / self.variation,
            "coverage": float(np.concatenate(covered).mean()),
            "nearest example": float(np.median(nearest)) / self.nearest,
            "jerk ratio": float(np.mean([_jerk(one) for one in variants])) / self.jerk,
            "beyond limits %": 100.0
            * float(np.mean([(one > BEYOND).mean() for one in beyond])),
            "spectrum": _spectral_overlap(self.spectrum, _spectrum(variants)),
        }


def _body(motion: Motion) -> np.ndarray:
    return positions_in_body_frame(motion)[
        :: max(round(motion.frame_rate / ALIGNMENT_RATE_HZ), 1)
    ]


def _variation(bodies: Sequence[np.ndarray]) -> tuple[float, np.ndarray]:
    """Return the mean distance of pairs and all distances, NaN where not measured."""
    distances = np.full((len(bodies), len(bodies)), np.nan)
    pairs = list(combinations(range(len(bodies)), 2))
    if len(pairs) > PAIRS + 10:
        chosen = np.random.default_rng(0).choice(len(pairs), PAIRS, replace=False)
        pairs = [pairs[index] for index in chosen]
    for i, j in pairs:
        distances[i, j] = distances[j, i] = warp(bodies[i], bodies[j]).cost
    return float(np.nanmean(distances)), distances


def _windows(motion: Motion) -> np.ndarray:
    """Return stretches of 11 frames at 30 Hz, shape (n, n_numbers), in meters of mean joint."""
    body = positions_in_body_frame(motion)[:: max(round(motion.frame_rate / WINDOW_RATE), 1)]
    body = body.reshape(len(body), -1) / np.sqrt(body.shape[1])
    starts = range(max(len(body) - WINDOW + 1, 1))
    held = [np.minimum(np.arange(start, start + WINDOW), len(body) - 1) for start in starts]
    return np.stack([body[frames].ravel() for frames in held])


def angular_velocities(motion: Motion) -> np.ndarray:
    """Return the angular velocities of joints from frame to frame, radians per second."""
    steps = multiply(inverse(motion.rotations[:-1]), motion.rotations[1:])
    return np.asarray(rotation_vector_from_quaternion(steps) * motion.frame_rate)


def _jerk(motion: Motion) -> float:
    """Return the mean absolute third difference of joint angles at 30 Hz, rad/s3.

    At 30 Hz for all, since some methods know no more.
    """
    motion = every(motion, max(round(motion.frame_rate / WINDOW_RATE), 1))
    return float(
        np.abs(np.diff(angular_velocities(motion), n=2, axis=0)).mean() * motion.frame_rate**2
    )


def _spectrum(motions: Sequence[Motion]) -> np.ndarray:
    """Return the mean power of angular velocity by frequency to 15 Hz and channel."""
    grid, powers = np.linspace(0.0, 15.0, 46), []
    for motion in motions:
        steps = angular_velocities(motion).reshape(motion.n_frames - 1, -1)
        size = max(round(4 * motion.frame_rate), len(steps))
        power = np.abs(np.fft.rfft(steps, size, axis=0)) ** 2
        tones = np.fft.rfftfreq(size, 1.0 / motion.frame_rate)
        powers.append(np.stack([np.interp(grid, tones, one) for one in power.T], axis=-1))
    return np.asarray(np.mean(powers, axis=0))


def _spectral_overlap(one: np.ndarray, other: np.ndarray) -> float:
    """Return the Bhattacharyya coefficient of spectra by channel, weighted by power: to 1."""
    weights = one.sum(axis=0)
    shapes = [each / np.maximum(each.sum(axis=0), 1e-12) for each in (one, other)]
    overlap = np.sqrt(shapes[0] * shapes[1]).sum(axis=0)
    return float((weights * overlap).sum() / weights.sum())


def contact_figures(motions: Sequence[Motion]) -> tuple[float, float]:
    """Return how fast feet in contact slide, cm/s, and in which part of the time they stand.

    As Check says (`measure_quality`): the same measure for examples and variants.
    """
    slides, stands = [], []
    for motion in motions:
        contacts = detect_contacts(motion)
        soles = sole_paths(motion, forward_kinematics(motion))
        feet = [
            measure_foot_slide(sole, contacts[:, side], motion.frame_rate)
            for side, sole in enumerate(soles)
        ]
        speeds = np.concatenate([foot.speed for foot in feet])
        if np.isfinite(speeds).any():
            slides.append(float(np.nanmean(speeds)))
        stands.append(float(contacts.mean()))
    return 100.0 * float(np.mean(slides or [np.nan])), float(np.mean(stands))
