"""What each joint or point does over time, told apart from what disturbs it."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from ...motion import Motion, Tracks
from ...progress import Progress
from ...rotations import unroll
from ...signals import disturbance

Array = NDArray[np.float64]

HALF_WINDOW = 0.12
"""Seconds to either side that the smooth course of a signal is fitted to."""
FEWEST_FRAMES = 3
SHAKE_WINDOW = 0.5
"""Seconds over which shaking is averaged."""


@dataclass(frozen=True, eq=False)
class Signal:
    """How one joint turns or moves, seen as a course with disturbances.

    Attributes
    ----------
    joint : str
    turns : bool
        True: rotation, in radians; False: position, in metres.
    noise : float, rad or m
        Robust standard deviation of the jitter of one component.
    deviation : shape (n_frames,), rad or m
        Distance from the smooth course; NaN where not observed.
    spike_threshold : float, rad or m
        Spikes are higher than this.
    spikes : bool, shape (n_frames,)
    shake : shape (n_frames,), rad or m
        Standard deviation of one component about each frame (`estimate_local_noise`).
    """

    joint: str
    turns: bool
    noise: float
    deviation: Array
    spike_threshold: float
    spikes: NDArray[np.bool_]
    shake: Array

    @property
    def gaps(self) -> NDArray[np.bool_]:
        """Frames in which the joint was not observed."""
        return np.asarray(np.isnan(self.deviation))


@dataclass(frozen=True)
class SpikeRule:
    """What counts as a spike: both must be exceeded."""

    times_noise: float
    turn: float
    """Radians."""
    move: float
    """Metres."""


def signals_of(
    recording: Motion | Tracks,
    rule: SpikeRule,
    progress: Progress,
    cuts: tuple[int, ...] = (),
) -> tuple[Signal, ...]:
    """Return one signal for each joint's rotation or point's position, and one for the root.

    End sites, which never turn, have none. No course leads across a cut.
    """
    half_window = max(FEWEST_FRAMES, round(HALF_WINDOW * recording.frame_rate))
    courses = list(_courses(recording))
    found = []
    places = _pulled_apart(recording.n_frames, cuts, half_window)
    for place, (joint, turns, course) in enumerate(courses):
        apart = np.full((places[-1] + 1, course.shape[1]), np.nan)
        apart[places] = course
        smallest = rule.turn if turns else rule.move
        told = disturbance(apart, half_window, smallest)
        threshold = max(smallest, rule.times_noise * told.scale)
        spikes = told.spikes(threshold)
        deviation = _angle(told.deviation) if turns else told.deviation
        calm = np.where(spikes[:, None], np.nan, apart)
        shake = estimate_local_noise(calm, round(SHAKE_WINDOW * recording.frame_rate))
        found.append(
            Signal(
                joint, turns, told.scale, deviation[places], threshold, spikes[places],
                shake[places],
            )
        )  # fmt: skip
        progress((place + 1) / len(courses), "Looking for spikes")
    return tuple(found)


def _pulled_apart(n_frames: int, cuts: tuple[int, ...], by: int) -> NDArray[np.intp]:
    """Return where to put frames so that `by` empty ones are at each cut."""
    moved = np.zeros(n_frames, dtype=np.intp)
    moved[list(cuts)] = by
    return np.asarray(np.arange(n_frames) + np.cumsum(moved))


def estimate_local_noise(course: Array, window: int) -> Array:
    """Return the standard deviation of one component of white noise about each frame.

    Third differences d of white noise follow each other with opposite sign: their covariance
    from one frame to the next is -(3 + 9 + 3) = -15 variances per component. Those of motion,
    however quick, follow each other with the same sign, so that motion is not taken for noise.

    Parameters
    ----------
    course : shape (n_frames, n_components), of three degrees of freedom; NaN is left out
    window : int, frames to average over
    """
    shake = np.zeros(len(course))
    if len(course) < 5:
        return shake
    differences = np.diff(course, n=3, axis=0)
    against = -np.sum(differences[1:] * differences[:-1], axis=1) / (3 * 15.0)
    known = np.isfinite(against)
    size = min(max(window, 1), len(against))
    power = uniform_filter1d(np.where(known, against, 0.0), size, mode="constant")
    share = uniform_filter1d(known.astype(np.float64), size, mode="constant")
    shake[2:-2] = np.sqrt(np.maximum(power, 0.0) / np.maximum(share, 1.0 / size))
    shake[:2], shake[-2:] = shake[2], shake[-3]
    return shake


def _courses(recording: Motion | Tracks) -> Iterator[tuple[str, bool, Array]]:
    if isinstance(recording, Tracks):
        for point, name in enumerate(recording.names):
            yield name, False, recording.positions[:, point]
        return
    skeleton = recording.skeleton
    yield skeleton.names[0], False, recording.root_positions
    # Twice the quaternion: neighbouring ones are then as far apart as their angle in radians.
    rotations = 2.0 * unroll(recording.rotations)
    for joint, name in enumerate(skeleton.names):
        if not skeleton.is_end_site(joint):
            yield name, True, rotations[:, joint]


def _angle(chord: Array) -> Array:
    """Angle in radians between rotations whose doubled quaternions are `chord` apart."""
    return np.asarray(4.0 * np.arcsin(np.minimum(chord / 4.0, 1.0)))
