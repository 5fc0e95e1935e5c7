"""Corrupt a clean motion as capture does: jitter, spikes, missing limbs, a drifting root."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import Motion, Skeleton
from ..rotations import multiply, quaternion_from_rotation_vector
from ..settings import Settings, setting

SWAY_PERIOD_S = 1.5
"""Seconds between the independent values of the root's sway: slower than a stride."""


@dataclass(frozen=True, kw_only=True)
class CorruptionSettings(Settings):
    """Kinds and magnitudes of corruption."""

    jitter: float = setting(
        3.0, "Standard deviation of the noise on each rotation channel",
        unit="deg", minimum=0.0, maximum=30.0,
    )  # fmt: skip
    spikes: float = setting(
        0.0, "Fraction of the samples of each rotation channel that become spikes",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    min_spike: float = setting(
        20.0, "Size of the smallest spike", unit="deg", minimum=0.0, maximum=180.0
    )
    max_spike: float = setting(
        60.0, "Size of the largest spike", unit="deg", minimum=0.0, maximum=180.0
    )
    root_jitter: float = setting(
        0.0, "Standard deviation of the noise on each coordinate of the root",
        unit="m", minimum=0.0, maximum=1.0,
    )  # fmt: skip
    root_sway: float = setting(
        0.0, "Standard deviation of slow drift of the root, which makes the feet slide",
        unit="m", minimum=0.0, maximum=1.0,
    )  # fmt: skip
    seed: int = setting(
        0, "Random seed; a different seed gives different noise", minimum=0, maximum=2**31 - 1
    )


def corrupt(
    motion: Motion,
    settings: CorruptionSettings = CorruptionSettings(),
    *,
    missing: Mapping[str, range] | None = None,
) -> Motion:
    """Return a corrupted copy of a motion.

    Every joint except the end sites is rotated, in its own frame, by a rotation vector of
    Gaussian noise. Spikes of random sign are added, with magnitudes uniform between the minimum
    and the maximum, for each channel separately. Noise is independent between frames, so the
    same settings at twice the frame rate give more jitter per second.

    Parameters
    ----------
    motion : Motion
        NaN stays NaN.
    settings : CorruptionSettings
    missing : mapping from joint name to frames
        In these frames the joint and all below it become NaN; for the root, its position too.

    Returns
    -------
    Motion

    Raises
    ------
    InvalidMotionError
        `missing` names a joint that does not exist, or frames outside the motion.
    """
    rng = np.random.default_rng(settings.seed)
    noise = rng.normal(0.0, 1.0, (motion.n_frames, motion.n_joints, 3)) * settings.jitter
    magnitude = rng.uniform(settings.min_spike, settings.max_spike, noise.shape)
    sign = rng.choice((-1.0, 1.0), noise.shape)
    noise += (rng.random(noise.shape) < settings.spikes) * sign * magnitude
    end_sites = [motion.skeleton.is_end_site(joint) for joint in range(motion.n_joints)]
    noise[:, end_sites] = 0.0
    noise_rotations = quaternion_from_rotation_vector(np.radians(noise))
    rotations = multiply(motion.rotations, noise_rotations)

    positions = motion.root_positions + settings.root_jitter * rng.normal(
        size=(motion.n_frames, 3)
    )
    positions[:, :2] += settings.root_sway * _slow_noise(motion, rng)
    for joint, frames in _gaps(motion, missing or {}):
        rotations[frames.start : frames.stop, motion.skeleton.subtree(joint)] = np.nan
        if joint == 0:
            positions[frames.start : frames.stop] = np.nan
    return motion.with_poses(rotations, positions)


def _slow_noise(motion: Motion, rng: np.random.Generator) -> NDArray[np.float64]:
    """Return unit-variance curves, shape (n_frames, 2), smooth over about a second."""
    time = np.arange(motion.n_frames) * motion.dt
    knots = np.arange(-1, int(time[-1] / SWAY_PERIOD_S) + 4) * SWAY_PERIOD_S
    return np.asarray(
        scipy.interpolate.CubicSpline(knots, rng.normal(size=(len(knots), 2)))(time)
    )


def _gaps(motion: Motion, missing: Mapping[str, range]) -> list[tuple[int, range]]:
    outside = [
        name
        for name, frames in missing.items()
        if frames.step != 1 or frames.start < 0 or frames.stop > motion.n_frames
    ]
    if outside:
        raise InvalidMotionError(
            f"The missing frames of {', '.join(outside)} must be a plain range within"
            f" 0 to {motion.n_frames}."
        )
    skeleton: Skeleton = motion.skeleton
    return [(skeleton.index(name), frames) for name, frames in missing.items()]
