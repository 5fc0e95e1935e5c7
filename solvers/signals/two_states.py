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
    total = begin_rate + end_rate
    changed = -np.expm1(-total / frame_rate)
    begin, end = changed * begin_rate / total, changed * end_rate / total
    ratios = np.exp(np.clip(evidence, -MAX_LOG_ODDS, MAX_LOG_ODDS))
    limit = np.exp(MAX_LOG_ODDS)
    past = np.empty_like(ratios)
    odds = np.full(ratios.shape[1:], begin_rate / end_rate)
    for frame, ratio in enumerate(ratios):
        past[frame] = odds = np.clip(odds * ratio, 1.0 / limit, limit)
        odds = (begin + (1.0 - end) * odds) / (1.0 - begin + end * odds)
    result = np.empty_like(ratios)
    future = np.ones(ratios.shape[1:])
    for frame in range(len(ratios) - 1, -1, -1):
        result[frame] = past[frame] * future / (1.0 + past[frame] * future)
        later = np.clip(ratios[frame] * future, 1.0 / limit, limit)
        future = (end + (1.0 - end) * later) / (1.0 - begin + begin * later)
    return result
