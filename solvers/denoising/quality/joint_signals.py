"""Separate each joint's or point's smooth motion from noise and spikes."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array
from ...motion import Motion, Tracks
from ...progress import Progress
from ...rotations import unroll
from ...signals import fit_lowess

HALF_WINDOW_S = 0.12
"""Seconds to either side over which the smooth trajectory is fitted. Half and twice gain less
than 1 % (`make sensitivity`)."""
MIN_HALF_WINDOW_FRAMES = 3
"""Frames to either side that the fit uses at least. Chosen by hand; `make sensitivity` varies
it."""
NOISE_WINDOW_S = 0.5
"""Seconds over which the local noise is averaged. Half and twice are no better
(`make sensitivity`)."""


@dataclass(frozen=True, eq=False)
class Signal:
    """The noise and spikes of one joint's rotation or position.

    Attributes
    ----------
    joint : str
    is_rotation : bool
        True: rotation, in radians; False: position, in meters.
    noise : float, rad or m
        Robust standard deviation of the jitter of one component.
    deviation : shape (n_frames,), rad or m
        Distance from the smooth trajectory; NaN where not observed.
    spike_threshold : float, rad or m
        Minimum height of a spike.
    spikes : bool, shape (n_frames,)
    local_noise : shape (n_frames,), rad or m
        Standard deviation of one component about each frame (`estimate_local_noise`).
    held : bool, shape (n_frames,)
        Frames in which it repeats the one before although the body moves on; also gaps.
    """

    joint: str
    is_rotation: bool
    noise: float
    deviation: Array
    spike_threshold: float
    spikes: NDArray[np.bool_]
    local_noise: Array
    held: NDArray[np.bool_]

    @property
    def gaps(self) -> NDArray[np.bool_]:
        """Frames in which the joint was not observed, or held."""
        return np.asarray(np.isnan(self.deviation))


@dataclass(frozen=True)
class SpikeRule:
    """Thresholds of a spike; it must exceed both."""

    noise_factor: float
    min_rotation: float
    """Radians."""
    min_displacement: float
    """Meters."""


def extract_signals(
    recording: Motion | Tracks,
    held: NDArray[np.bool_],
    rule: SpikeRule,
    progress: Progress,
    cuts: tuple[int, ...] = (),
) -> tuple[Signal, ...]:
    """Return one signal for each joint's rotation or point's position, and one for the root.

    `held`, (n_frames, n_parts), is from `find_held_samples`; these samples are missing. End
    sites have no rotation and no signal. No trajectory spans a cut.
    """
    half_window = max(MIN_HALF_WINDOW_FRAMES, round(HALF_WINDOW_S * recording.frame_rate))
    trajectories = list(_trajectories(recording, held))
    signals = []
    padded_frames = _spread_at_cuts(recording.n_frames, cuts, half_window)
    for index, (joint, is_rotation, trajectory, is_held) in enumerate(trajectories):
        padded = np.full((padded_frames[-1] + 1, trajectory.shape[1]), np.nan)
        padded[padded_frames] = trajectory
        min_spike = rule.min_rotation if is_rotation else rule.min_displacement
        disturbed = fit_lowess(padded, half_window, min_spike)
        threshold = max(min_spike, rule.noise_factor * disturbed.scale)
        spikes = disturbed.spikes(threshold)
        deviation = (
            _angle_from_chord(disturbed.deviation) if is_rotation else disturbed.deviation
        )
        without_spikes = np.where(spikes[:, None], np.nan, padded)
        local_noise = estimate_local_noise(
            without_spikes, round(NOISE_WINDOW_S * recording.frame_rate)
        )
        signals.append(
            Signal(
                joint, is_rotation, disturbed.scale, deviation[padded_frames], threshold,
                spikes[padded_frames], local_noise[padded_frames], is_held,
            )
        )  # fmt: skip
        progress((index + 1) / len(trajectories), "Finding spikes")
    return tuple(signals)


def _spread_at_cuts(n_frames: int, cuts: tuple[int, ...], by: int) -> NDArray[np.intp]:
    """Return new frame indices that leave `by` empty frames at each cut."""
    padding = np.zeros(n_frames, dtype=np.intp)
    padding[list(cuts)] = by
    return np.asarray(np.arange(n_frames) + np.cumsum(padding))


def estimate_local_noise(trajectory: Array, window: int) -> Array:
    """Return the standard deviation of one component of white noise about each frame.

    Consecutive third differences d of white noise have opposite signs: their covariance is
    -(3 + 9 + 3) = -15 variances per component. Those of motion, however fast, have the same
    sign, so motion is not mistaken for noise.

    Parameters
    ----------
    trajectory : shape (n_frames, n_components), of three degrees of freedom; NaN is skipped
    window : int, frames to average over
    """
    local_noise = np.zeros(len(trajectory))
    if len(trajectory) < 5:
        return local_noise
    differences = np.diff(trajectory, n=3, axis=0)
    lagged_products = -np.sum(differences[1:] * differences[:-1], axis=1) / (3 * 15.0)
    observed = np.isfinite(lagged_products)
    size = min(max(window, 1), len(lagged_products))
    power = scipy.ndimage.uniform_filter1d(
        np.where(observed, lagged_products, 0.0), size, mode="constant"
    )
    observed_fraction = scipy.ndimage.uniform_filter1d(
        observed.astype(np.float64), size, mode="constant"
    )
    local_noise[2:-2] = np.sqrt(
        np.maximum(power, 0.0) / np.maximum(observed_fraction, 1.0 / size)
    )
    local_noise[:2], local_noise[-2:] = local_noise[2], local_noise[-3]
    return local_noise


def _trajectories(
    recording: Motion | Tracks, held: NDArray[np.bool_]
) -> Iterator[tuple[str, bool, Array, NDArray[np.bool_]]]:
    if isinstance(recording, Tracks):
        for point, name in enumerate(recording.names):
            yield name, False, recording.positions[:, point], held[:, point]
        return
    skeleton = recording.skeleton
    yield skeleton.names[0], False, recording.root_positions, held[:, -1]
    # Twice the quaternion: the distance of neighbors is then their angle in radians.
    rotations = 2.0 * unroll(recording.rotations)
    for joint, name in enumerate(skeleton.names):
        if not skeleton.is_end_site(joint):
            yield name, True, rotations[:, joint], held[:, joint]


def _angle_from_chord(chord: Array) -> Array:
    """Return the angle in radians of rotations whose doubled quaternions differ by `chord`."""
    return np.asarray(4.0 * np.arcsin(np.minimum(chord / 4.0, 1.0)))
