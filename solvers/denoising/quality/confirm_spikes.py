"""Separate spikes from fast movement, with the outlier model of Clean."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Flags
from ...motion import Motion
from ...motion.skeletons import is_short_shot, shot_ranges
from ...signals import fill_channel_gaps
from ..channels import CENTIMETERS, encode
from ..motion_model import load_motion_mixture
from ..outliers import confirm_outliers, find_bursts
from .joint_signals import Signal

MAX_SPIKES_PER_FRAME = 1.0
"""Spikes of all joints per frame, a mean over a shot, above which all of them count. It bounds
the run time: a climb without errors has 0.3, a take with 10 % of outliers has 4."""
ERROR_RATE = 1e-5
"""Errors per sample that a list assumes: one in an hour of a channel at 30 Hz. Measured on
development takes of the first press: the odds of all 219 suspects that are fast movement are
below 8e4; those of 94 % of lone errors by 25 to 60 degrees are above 1e5. Clean assumes far
fewer, since it changes what it takes for an error."""


def confirm_spikes(
    motion: Motion, signals: tuple[Signal, ...], cuts: tuple[int, ...]
) -> tuple[Signal, ...]:
    """Return signals whose spikes are not movement, with errors of several frames added.

    A trajectory that is smooth within a quarter of a second misses the turning points of fast
    movement and follows an error of several frames. The motion mixture explains the former
    (`confirm_outliers`) and finds the latter (`find_bursts`), as in Clean.

    Parameters
    ----------
    motion : Motion
        Held samples are missing.
    signals : tuple of Signal
        Position of the root, then rotations of joints.
    cuts : tuple of int
        First frames of shots. Shots that are too short to be cleaned keep their spikes.
    """
    spikes = np.stack([signal.spikes for signal in signals], axis=1)
    heights = np.zeros(spikes.shape)
    for start, stop in shot_ranges(motion, cuts):
        shot = motion.slice(start, stop)
        if not is_short_shot(shot.n_frames, shot.frame_rate) and shot.observed.any():
            frames = slice(start, stop)
            spikes[frames], heights[frames] = _errors(shot, signals, spikes[frames])
    confirmed = []
    for signal, is_error, height in zip(signals, spikes.T, heights.T, strict=True):
        is_added = is_error & ~signal.spikes & (height > signal.spike_threshold)
        confirmed.append(
            replace(
                signal,
                spikes=is_added | (is_error & signal.spikes),
                deviation=np.where(is_added, height, signal.deviation),
            )
        )
    return tuple(confirmed)


def _errors(shot: Motion, signals: tuple[Signal, ...], spikes: Flags) -> tuple[Flags, Array]:
    """Return which samples are errors, and their distance from the movement, rad or m."""
    channels, mixture = encode(shot), load_motion_mixture()
    values = channels.flat
    column_of = _parts_of_signals(shot, signals, channels.joints)
    suspected = np.zeros(channels.values.shape, dtype=np.bool_)
    suspected[:, column_of] = spikes[:, :, None]
    bursts = find_bursts(values, shot.frame_rate, mixture)
    is_error = suspected.reshape(values.shape) & np.isfinite(values) & ~bursts
    complete = fill_channel_gaps(np.where(is_error | bursts, np.nan, values))
    if np.count_nonzero(spikes) <= MAX_SPIKES_PER_FRAME * shot.n_frames:
        is_error = confirm_outliers(
            values, is_error, complete, shot.frame_rate, mixture, ERROR_RATE
        )
    distances = np.linalg.norm((values - complete).reshape(suspected.shape), axis=2)
    units = np.where(
        [signal.is_rotation for signal in signals], np.radians(1.0), 1 / CENTIMETERS
    )
    errors = (is_error | bursts).reshape(suspected.shape).any(axis=2)
    return errors[:, column_of], np.nan_to_num(distances[:, column_of] * units)


def _parts_of_signals(
    motion: Motion, signals: tuple[Signal, ...], joints: NDArray[np.intp]
) -> list[int]:
    """Return the part of the channels of each signal; the last one is the body's position."""
    part_of = {motion.skeleton.names[joint]: part for part, joint in enumerate(joints[:-1])}
    return [
        part_of[signal.joint] if signal.is_rotation else len(joints) - 1 for signal in signals
    ]
