"""The filter that live trackers are usually smoothed with."""

import numpy as np

from solvers.arrays import Array


def one_euro(
    noisy: Array, frame_rate: float, slowest: float, speed_gain: float, of_speed: float = 1.0
) -> Array:
    """Low-pass each channel, less where it moves fast (Casiez, Roussel, Vogel, CHI 2012).

    Parameters
    ----------
    noisy : shape (n_frames, n_channels)
    frame_rate : float, hertz
    slowest : float
        Cut-off at rest, hertz; "mincutoff".
    speed_gain : float
        By how much it rises with speed, hertz per (unit / s); "beta".
    of_speed : float
        Cut-off of the speed, hertz; "dcutoff".
    """
    result = np.array(noisy, dtype=np.float64)
    speed = np.zeros(noisy.shape[1])
    speed_weight = _smoothing_weight(np.full(noisy.shape[1], of_speed), frame_rate)
    for frame in range(1, len(noisy)):
        # As in the authors' code, the speed is that of the raw value from the last result.
        now = (noisy[frame] - result[frame - 1]) * frame_rate
        speed = speed + speed_weight * (now - speed)
        weight = _smoothing_weight(slowest + speed_gain * np.abs(speed), frame_rate)
        result[frame] = result[frame - 1] + weight * (noisy[frame] - result[frame - 1])
    return result


def _smoothing_weight(cut_off: Array, frame_rate: float) -> Array:
    """Weight of the new value in an exponential mean."""
    return 1.0 / (1.0 + frame_rate / (2.0 * np.pi * cut_off))
