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
    changes = _changes(1.0 / frame_rate, begin_rate, end_rate)
    n_sequences = int(np.prod(evidence.shape[1:]))
    ratios = _likelihood_ratios(evidence).reshape(len(evidence), n_sequences)
    result = np.empty_like(ratios)
    for column in range(n_sequences):
        result[:, column] = _probabilities(
            ratios[:, column].tolist(), begin_rate / end_rate, *changes
        )
    return result.reshape(evidence.shape)


def _probabilities(ratios: list[float], prior: float, begin: float, end: float) -> list[float]:
    """Return the probabilities of one sequence, in floats: a long take has many short steps."""
    largest = float(np.exp(MAX_LOG_ODDS))
    smallest = 1.0 / largest
    past, odds = [], prior
    for ratio in ratios:
        found = min(max(odds * ratio, smallest), largest)
        past.append(found)
        odds = (begin + (1.0 - end) * found) / (1.0 - begin + end * found)
    result, future = [], 1.0
    for ratio, before in zip(reversed(ratios), reversed(past), strict=True):
        result.append(before * future / (1.0 + before * future))
        later = min(max(ratio * future, smallest), largest)
        future = (end + (1.0 - end) * later) / (1.0 - begin + begin * later)
    return result[::-1]


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
        """Return the odds instead of the probability, same shape; see `update`."""
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
