"""A hidden Markov model of how a foot in contact with the ground moves."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array, Flags
from ...signals import estimate_noise, fill_channel_gaps, smooth_gaussian

SPEED_NOISE = 0.15
"""Meters per second: feet are smoothed until noise moves them no faster along each axis. Chosen
by hand: x0.7 and x1.7 change F1 of noisy captures by less than 0.02, of others by nothing."""

GROUND_WINDOW_S = 0.5
"""Seconds before and after a frame in which the lower foot stands on a level that counts as
ground. It guards feet that swing in the air: they are nowhere as long."""

MAX_CLIMB_M = 0.3
"""Maximum height of ground above the lowest of the take. It guards feet that hang or rest in
the air."""


@dataclass(frozen=True)
class ContactModel:
    """Hidden Markov model of a foot; lengths and speeds are for a leg of 0.9 m.

    The log odds of contact are `bias` while the slower and lower of ankle and toes rests on the
    ground. They decrease with the logarithm of its speed and height.
    """

    bias: float
    speed_weight: float
    speed: float
    """Meters per second, above which speed counts."""
    height_weight: float
    height: float
    """Meters, above which height counts."""
    memory: float
    """Seconds of motion that are one independent observation."""
    landing_rate: float
    """Per second in the air."""
    lift_rate: float
    """Per second on the ground."""


LEARNED = ContactModel(
    bias=30.5,
    speed_weight=10.7,
    speed=0.152,
    height_weight=7.98,
    height=0.0116,
    memory=0.616,
    landing_rate=4.09,
    lift_rate=2.59,
)
"""Learned by `tests/training/learn_contacts.py`."""


@dataclass(frozen=True, eq=False)
class FeetInMotion:
    """How fast and how high ankles and toes are, shapes (n_frames, 2 feet, 2 points).

    Attributes
    ----------
    observed : bool
    speeds : meters per second
    heights : meters above the ground
    independence : float, seconds
        Duration in which smoothing leaves one independent sample.
    dt : float, seconds
    """

    observed: Flags
    speeds: Array
    heights: Array
    independence: float
    dt: float

    def evidence(self, model: ContactModel) -> Array:
        """Return the log odds that the frame by itself adds for contact, (n_frames, 2)."""
        speed = (self.speeds / model.speed) ** 2
        height = (np.maximum(self.heights, 0.0) / model.height) ** 2
        log_odds = (
            model.bias
            - model.speed_weight * np.log1p(speed)
            - model.height_weight * np.log1p(height)
        )
        best = np.where(self.observed, log_odds, -np.inf).max(axis=-1)
        best = np.where(self.observed.any(axis=-1), best, 0.0)
        return np.asarray(best * self.dt / (model.memory + self.independence))


def measure_feet(positions: Array, frame_rate: float) -> FeetInMotion:
    """Smooth feet as much as their noise demands, and measure speeds and heights.

    White noise of deviation s moves what a Gaussian of deviation t smooths at
    s sqrt(dt / (4 sqrt(pi) t^3)) along each axis.

    Parameters
    ----------
    positions : shape (n_frames, 2, 2, 3), meters, for a leg of 0.9 m
    frame_rate : float, hertz
    """
    dt = 1.0 / frame_rate
    observed = np.isfinite(positions).all(axis=-1)
    columns = positions.reshape(len(positions), -1)
    noise = float(np.median(estimate_noise(columns)))
    width = float(np.cbrt(noise**2 * dt / (4.0 * np.sqrt(np.pi)) / SPEED_NOISE**2))
    path = smooth_gaussian(fill_channel_gaps(columns), width * frame_rate)
    path = path.reshape(positions.shape)
    independence = 2.0 * np.sqrt(np.pi) * width
    speed_noise = min(SPEED_NOISE, np.sqrt(2.0) * noise * frame_rate)
    heights = [
        _above_ground(path[:, :, point, 2], observed[:, :, point].any(axis=0), frame_rate)
        for point in range(2)
    ]
    return FeetInMotion(
        observed,
        np.sqrt(np.maximum(_speeds(path, frame_rate) ** 2 - 3.0 * speed_noise**2, 0.0)),
        np.stack(heights, axis=-1),
        independence,
        dt,
    )


def _speeds(path: Array, frame_rate: float) -> Array:
    """Return the lower of the speeds before and after each frame, shape of `path` without axes.

    So the first and the last frame of a contact are as slow as those between them.
    """
    if len(path) == 1:
        return np.zeros(path.shape[:-1])
    steps = np.linalg.norm(np.diff(path, axis=0), axis=-1) * frame_rate
    return np.minimum(np.concatenate([steps[:1], steps]), np.concatenate([steps, steps[-1:]]))


def _above_ground(heights: Array, seen: Flags, frame_rate: float) -> Array:
    """Return the heights of both ankles (or toes) above the ground, shape (n_frames, 2).

    The ground of a frame is the highest level within a second above which the lower foot stays
    for a second: a foot on a box is on the ground if the other one follows.
    """
    from scipy.ndimage import maximum_filter1d, minimum_filter1d  # slow to import

    if not seen.any():
        return heights
    lower = heights[:, seen].min(axis=1)
    window = round(GROUND_WINDOW_S * frame_rate)
    level = minimum_filter1d(lower, 2 * window + 1, mode="nearest")
    level = maximum_filter1d(level, 4 * window + 1, mode="nearest")
    return heights - np.minimum(level, level.min() + MAX_CLIMB_M)[:, None]
