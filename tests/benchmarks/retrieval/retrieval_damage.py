"""What is done to queries: missing joints, noise, other speeds."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from solvers.motion import Tracks, resample
from solvers.motion.humanoid.posture_joints import HIPS, N_JOINTS

Random = np.random.Generator
Damage = Callable[[Tracks, Random], Tracks]

MISSING = 0.3
NOISE = 0.02
"""Meters; standard deviation of each coordinate, new in each frame."""


def unharmed(tracks: Tracks, random: Random) -> Tracks:
    return tracks


def lose_joints(tracks: Tracks, random: Random) -> Tracks:
    """Remove 30 % of the joints in all frames, any but the hips."""
    others = np.setdiff1d(np.arange(N_JOINTS), [HIPS])
    missing = random.choice(others, round(MISSING * N_JOINTS), replace=False)
    positions = tracks.positions.copy()
    positions[:, missing] = np.nan
    return replace(tracks, positions=positions)


def lose_at_random(tracks: Tracks, random: Random) -> Tracks:
    """Lose 30 % of all joints in all frames, the hips too."""
    missing = random.uniform(size=tracks.positions.shape[:2]) < MISSING
    return replace(tracks, positions=np.where(missing[..., None], np.nan, tracks.positions))


def add_noise(tracks: Tracks, random: Random) -> Tracks:
    noise = random.normal(scale=NOISE, size=tracks.positions.shape)
    return replace(tracks, positions=tracks.positions + noise)


def at_speed(speed: float, tracks: Tracks) -> Tracks:
    """Return the clip at this speed, at the same frame rate."""
    faster = replace(tracks, frame_rate=tracks.frame_rate * speed)
    return resample(faster, tracks.frame_rate)


DAMAGES: dict[str, Damage] = {
    "clean": unharmed,
    "joints missing": lose_joints,
    "missing at random": lose_at_random,
    "noise 2 cm": add_noise,
    "0.7x speed": lambda tracks, random: at_speed(0.7, tracks),
    "1.4x speed": lambda tracks, random: at_speed(1.4, tracks),
}
