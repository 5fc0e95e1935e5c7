"""The probability of a state that persists is that of all sequences together."""

from itertools import product

import numpy as np
from numpy.testing import assert_allclose

from solvers.signals import TwoStateFilter, two_state_probabilities

BEGIN, END = 2.0, 3.0


def probability_by_enumeration(evidence: np.ndarray, frame_rate: float) -> np.ndarray:
    changed = 1.0 - np.exp(-(BEGIN + END) / frame_rate)
    begin, end = changed * BEGIN / (BEGIN + END), changed * END / (BEGIN + END)
    steps = np.array([[1.0 - begin, begin], [end, 1.0 - end]])
    total, second = 0.0, np.zeros(len(evidence))
    for states in map(np.array, product((0, 1), repeat=len(evidence))):
        weight = (END, BEGIN)[states[0]] * np.exp((evidence * states).sum())
        weight *= steps[states[:-1], states[1:]].prod()
        total += weight
        second += weight * states
    return second / total


def test_probability_is_the_sum_over_all_sequences(rng):
    evidence = rng.normal(scale=2.0, size=(7, 2))

    found = two_state_probabilities(evidence, 5.0, BEGIN, END)

    expected = [probability_by_enumeration(one, 5.0) for one in evidence.T]
    assert_allclose(found, np.transpose(expected))


def test_frames_without_evidence_have_the_prior_probability_at_any_rate():
    for frame_rate in (1.0, 1000.0):
        found = two_state_probabilities(np.zeros((50, 1)), frame_rate, BEGIN, END)

        assert_allclose(found, BEGIN / (BEGIN + END))


def test_certain_evidence_overflows_nothing():
    evidence = np.repeat([1e6, -1e6], 2000)[:, None]

    found = two_state_probabilities(evidence, 60.0, BEGIN, END)[:, 0]

    assert found[:2000].min() > 0.999 and found[2000:].max() < 0.001


def test_filter_knows_only_the_frames_so_far(rng):
    evidence = rng.normal(scale=2.0, size=(7, 2))

    filtered = TwoStateFilter(BEGIN, END)
    found = [filtered.update(each, 1.0 / 5.0) for each in evidence]

    expected = [
        [probability_by_enumeration(one[: frame + 1], 5.0)[-1] for one in evidence.T]
        for frame in range(len(evidence))
    ]
    assert_allclose(found, expected)
