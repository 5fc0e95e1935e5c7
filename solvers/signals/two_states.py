"""The probability over time of one of two states that persist, from evidence in each frame."""

import numpy as np

from ..arrays import Array

MAX_LOG_ODDS = 30.0
"""Logarithm of the largest odds of a frame. It guards against overflow; these are certain."""


def two_state_probabilities(
    evidence: Array, frame_rate: float, begin_rate: float, end_rate: float
) -> Array:
    """Return the probability of the second state in each frame, given all frames.

    A hidden Markov model in continuous time: the states alternate at given rates, so that the
    result does not depend on the frame rate. The forward-backward algorithm [1]_ on odds.

    Parameters
    ----------
    evidence : shape (n_frames, ...)
        Logarithm of the likelihood ratio of the second state to the first, frame by frame.
    frame_rate : float, hertz
    begin_rate, end_rate : float, 1/s
        How often the second state begins while in the first, and ends while in the second.

    Returns
    -------
    Array of the same shape

    References
    ----------
    .. [1] Rabiner (1989). A tutorial on hidden Markov models and selected applications in
       speech recognition. Proceedings of the IEEE 77(2). doi:10.1109/5.18626
    """
    begin, end = _changes(1.0 / frame_rate, begin_rate, end_rate)
    ratios = _likelihood_ratios(evidence)
    limit = np.exp(MAX_LOG_ODDS)
    past = np.empty_like(ratios)
    filtered = TwoStateFilter(begin_rate, end_rate)
    for frame, each in enumerate(evidence):
        past[frame] = filtered.odds(each, 1.0 / frame_rate)
    result = np.empty_like(ratios)
    future = np.ones(ratios.shape[1:])
    for frame in range(len(ratios) - 1, -1, -1):
        result[frame] = past[frame] * future / (1.0 + past[frame] * future)
        later = np.clip(ratios[frame] * future, 1.0 / limit, limit)
        future = (end + (1.0 - end) * later) / (1.0 - begin + begin * later)
    return result


class TwoStateFilter:
    """`two_state_probabilities` without later frames, one frame after another.

    Parameters
    ----------
    begin_rate, end_rate : float, 1/s
    """

    def __init__(self, begin_rate: float, end_rate: float) -> None:
        self._rates = begin_rate, end_rate
        self._odds: Array | float | None = None

    def update(self, evidence: Array, elapsed_s: float) -> Array:
        """Return the probability of the second state, given the frames up to this one.

        Parameters
        ----------
        evidence : of any shape, always the same
        elapsed_s : float, seconds since the last frame
        """
        odds = self.odds(evidence, elapsed_s)
        return np.asarray(odds / (1.0 + odds))

    def odds(self, evidence: Array, elapsed_s: float) -> Array:
        """Return the odds instead of the probability; see `update`."""
        if self._odds is None:
            odds: Array | float = self._rates[0] / self._rates[1]
        else:
            begin, end = _changes(elapsed_s, *self._rates)
            odds = (begin + (1.0 - end) * self._odds) / (1.0 - begin + end * self._odds)
        limit = np.exp(MAX_LOG_ODDS)
        found = np.clip(odds * _likelihood_ratios(evidence), 1.0 / limit, limit)
        self._odds = found
        return np.asarray(found)


def _changes(elapsed_s: float, begin_rate: float, end_rate: float) -> tuple[float, float]:
    """Return the probabilities that the second state began, or ended, in a time."""
    total = begin_rate + end_rate
    changed = -float(np.expm1(-total * elapsed_s))
    return changed * begin_rate / total, changed * end_rate / total


def _likelihood_ratios(evidence: Array) -> Array:
    return np.asarray(np.exp(np.clip(evidence, -MAX_LOG_ODDS, MAX_LOG_ODDS)))
