"""Clean without examples, and the peers: filters of curves that know nothing of bodies.

No peer is tuned on the truth. Peers that cannot bridge a gap are given straight lines in it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.denoising import DenoiseMethod, DenoiseSettings, denoise
from solvers.motion import Motion
from solvers.signals import fill_channel_gaps

from ..peers import kalman, smoothers
from ..peers.one_euro import one_euro
from .conditions import Case

OURS, PUBLISHED, INPUT = "ours", "[LC10] as published", "input"
GAUSSIAN_S, SAVITZKY_GOLAY_S = 0.04, 0.3
"""Standard deviation and length of the windows, in seconds. Chosen by hand, not
swept, as are the settings of one-euro and Kalman below."""


@dataclass(frozen=True, eq=False)
class Result:
    """What a method returns."""

    motion: Motion
    flagged: NDArray[np.bool_] | None = None
    """Samples reported as outliers."""
    confidence: Array | None = None
    """0 to 1 for each joint, shape (n_frames, n_joints)."""


Filter = Callable[[Case], Result]


def _denoised(case: Case, method: DenoiseMethod = DenoiseMethod.DEFAULT) -> Result:
    result = denoise(case.given, settings=DenoiseSettings(method=method))
    assert isinstance(result.recording, Motion)
    body = slice(result.recording.n_joints - case.truth.n_joints, None)
    return Result(
        case.body_of(result.recording), result.outliers[:, body], result.confidence[:, body]
    )


def _smoothed(smoother: Callable[[Array, float], Array], case: Case) -> Result:
    curves = smoother(case.corrupted, case.truth.frame_rate)
    return Result(case.motion(curves))


def _bridged(smoother: Callable[[Array, float], Array], case: Case) -> Result:
    curves = smoother(fill_channel_gaps(case.corrupted), case.truth.frame_rate)
    return Result(case.motion(curves))


def _gaussian(noisy: Array, rate: float) -> Array:
    return smoothers.gaussian(noisy, rate, GAUSSIAN_S * rate)


def _savitzky_golay(noisy: Array, rate: float) -> Array:
    return smoothers.savitzky_golay(noisy, rate, 2 * round(SAVITZKY_GOLAY_S * rate / 2) + 1)


def _gcv(noisy: Array, rate: float) -> Array:
    if np.isnan(noisy).any():
        return smoothers.gcv_spline_over_gaps(noisy, rate)
    return smoothers.gcv_spline(noisy, rate)


PEERS: dict[str, Filter] = {
    "interpolation": partial(_bridged, smoothers.unchanged),
    "GCV spline": partial(_smoothed, _gcv),
    "Hampel + GCV spline": partial(_bridged, smoothers.hampel_gcv_spline),
    "Butterworth 6 Hz": partial(_bridged, smoothers.butterworth),
    "Savitzky-Golay": partial(_bridged, _savitzky_golay),
    "Gaussian": partial(_bridged, _gaussian),
    "one-euro": partial(_bridged, partial(one_euro, slowest=1.0, speed_gain=0.05)),
    "Kalman RTS": partial(_smoothed, partial(kalman.constant_velocity, agility=0.3)),
}
METHODS: dict[str, Filter] = {
    OURS: _denoised,
    PUBLISHED: partial(_denoised, method=DenoiseMethod.PUBLISHED),
    **PEERS,
}
