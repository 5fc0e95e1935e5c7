"""Adapt the relation of a body's joints to a take, by hiding limbs where they are observed."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...signals import find_runs
from ..averaging import MIN_NOISE
from ..window_priors import N_OVERLAPS
from .bridges import N_FEATURES, Bridge

MIN_GAP_S = 0.25
"""Seconds: the estimate by the take's own patterns fills shorter gaps. Sweep on the development
takes of the first press."""
OWN_RIDGE = 100.0
"""Evidence for the general relation, in frames at TRIAL_RATE_HZ, each counted N_OVERLAPS times.
Sweep on the development takes of the first press: x0.5 and x2 move 0.5 %."""
TRIAL_RATE_HZ = 30.0
"""Hertz: trial gaps of faster recordings are described at about this rate. By definition that
of the patterns of Clean."""
MAX_TRIALS = 120
"""Trial gaps in a take, and one more in each stretch without gaps. It bounds the run time."""
N_FOLDS = 5
"""Number of parts of the take that are predicted from the other parts. Chosen by hand;
`make sensitivity` varies it."""
PRIOR_TRIALS = 1.0
"""Number of gaps of evidence that the prediction is right as it is, by definition one. It
guards takes too short to test it."""
VARIANCE_PRIOR_TRIALS = 0.1
"""Number of gaps of evidence that the error varies as that of other people. Sweep on the
development takes of the first press, by the calibration of confidence: x0.5 raises its expected
error from 4.9 to 6.2 %, x2 to 6.0 %, 0 to 8.0 %."""


class Trials(NamedTuple):
    """Gaps elsewhere in the take, where the limb is known; a row for each of their frames."""

    features: Array
    """Shape (n_rows, n_features)."""
    deviations: Array
    """Of the limb from the line across the gap, shape (n_rows, n_channels), degrees."""
    bounds: NDArray[np.intp]
    """First frame of the gap and the first one after it, shape (n_rows, 2)."""
    n_independent: float
    """Number of gaps that would not overlap."""

    @property
    def length(self) -> float:
        """Mean length of a gap, frames."""
        return float(np.diff(self.bounds, axis=1).mean())


class AdaptedRelation(NamedTuple):
    """Relation of a limb to the rest of the body in this take."""

    regression: Array
    """From features to deviations, shape (n_features, n_channels)."""
    weight: float
    """Of the predicted deviation, 0 (the straight line) to 1, by the trials."""
    variance: Array
    """Of the error per frame of gap length, shape (n_channels,), square degrees."""


def describe_gap(bridge: Bridge, limb: Array, body: Array) -> Array:
    """Return the features of a gap, shape (n_described, 3 * (n_limb + n_body channels))."""
    parts = (bridge.missing_features(limb), bridge.observed_features(body))
    return np.concatenate([each.reshape(len(bridge.frames), -1) for each in parts], axis=1)


def try_gaps(
    limb: Array, body: Array, known: NDArray[np.bool_], length: int, frame_rate: float
) -> Trials:
    """Hide the limb where it is observed, for as long as it is missing or as there is room.

    Parameters
    ----------
    limb, body : shape (n_frames, n_channels), degrees or centimeters
    known : shape (n_frames,)
        Where the limb was observed.
    length : int, frames
    frame_rate : float, Hz
    """
    step = max(round(frame_rate / TRIAL_RATE_HZ), 1)
    bridges, n_independent = [], 0.0
    for start, stop in find_runs(known):
        tried = min(length, stop - start - 2)
        if tried < MIN_GAP_S * frame_rate:
            continue
        n_trials = min(
            N_OVERLAPS * (stop - start) // tried,
            1 + MAX_TRIALS * (stop - start) // len(known),
        )
        firsts = np.unique(np.linspace(start + 1, stop - tried - 1, n_trials).astype(int))
        bridges += [Bridge(first, first + tried, frame_rate, step) for first in firsts.tolist()]
        n_independent += (stop - start) / tried
    if not bridges:
        n_features = N_FEATURES * (limb.shape[1] + body.shape[1])
        empty = np.zeros((0, n_features)), np.zeros((0, limb.shape[1]))
        return Trials(*empty, np.zeros((0, 2), dtype=np.intp), 0.0)
    return Trials(
        np.concatenate([describe_gap(bridge, limb, body) for bridge in bridges]),
        np.concatenate([bridge.deviation(limb) for bridge in bridges]),
        np.repeat(
            [(bridge.start, bridge.stop) for bridge in bridges],
            [len(bridge.frames) for bridge in bridges],
            axis=0,
        ),
        n_independent,
    )


def adapt_relation(trials: Trials, general: Array, general_variance: Array) -> AdaptedRelation:
    """Return the posterior of a Gaussian regression about the general one, and its accuracy.

    Each part of the take is predicted from the trials outside it. The weight is that of the
    least squared error; the general relation counts as one more gap that was predicted well.
    The variance is the mean of that of the trials and the general one, shape (n_channels,), per
    frame of gap length.
    """
    x, y = trials.features, trials.deviations
    if not len(x):
        return AdaptedRelation(general, 1.0, general_variance)
    scale = OWN_RIDGE * np.maximum((y**2).mean(axis=0), MIN_NOISE**2)
    predicted = np.zeros_like(y)
    order = np.argsort(trials.bounds[:, 0], kind="stable")
    for fold in np.array_split(order, min(N_FOLDS, len(order))):
        first, last = trials.bounds[fold, 0].min(), trials.bounds[fold, 1].max()
        others = (trials.bounds[:, 1] <= first) | (trials.bounds[:, 0] >= last)
        predicted[fold] = x[fold] @ _ridge(x[others], y[others], general, scale)
    power, agreement = (predicted**2).sum(), (predicted * y).sum()
    prior = PRIOR_TRIALS / trials.n_independent * power + MIN_NOISE**2
    weight = float(np.clip((agreement + prior) / (power + prior), 0.0, 1.0))
    own_variance = ((y - weight * predicted) ** 2).mean(axis=0) / trials.length
    fraction = VARIANCE_PRIOR_TRIALS / (VARIANCE_PRIOR_TRIALS + trials.n_independent)
    variance = own_variance + fraction * (general_variance - own_variance)
    return AdaptedRelation(_ridge(x, y, general, scale), weight, variance)


def _ridge(x: Array, y: Array, general: Array, scale: Array) -> Array:
    """Return the regression of y on x that a ridge (n_channels,) draws to the general one."""
    eigenvalues, vectors = np.linalg.eigh(x.T @ x)
    residual = vectors.T @ (x.T @ (y - x @ general))
    return np.asarray(
        general + vectors @ (residual / (np.maximum(eigenvalues, 0.0)[:, None] + scale))
    )
