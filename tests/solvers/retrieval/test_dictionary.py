"""K-SVD recovers true atoms, also with missing joints."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError, SolveCancelled
from solvers.retrieval.postures.clip_postures import ClipPostures
from solvers.retrieval.published.dictionary import (
    DictionarySettings,
    PostureDictionary,
    learn_dictionary,
)
from solvers.retrieval.published.observed_signals import observed_signals
from solvers.retrieval.published.sparse_codes import sparse_codes


def as_clip(signals, frame_rate=30.0):
    n_frames = len(signals)
    return ClipPostures(signals.reshape(n_frames, 20, 3), np.zeros((n_frames, 4)), frame_rate)


def sums_of_random_atoms(rng, n_atoms=12, n_frames=800, n_nonzeros=2):
    atoms = np.linalg.qr(rng.normal(size=(60, 60)))[0][:n_atoms]
    weights = np.zeros((n_frames, n_atoms))
    for row in weights:
        chosen = rng.choice(n_atoms, n_nonzeros, replace=False)
        row[chosen] = rng.choice([-1.0, 1.0], n_nonzeros) * rng.uniform(1.0, 2.0, n_nonzeros)
    return atoms, weights @ atoms


def test_known_atoms_are_recovered(rng):
    atoms, signals = sums_of_random_atoms(rng)
    settings = DictionarySettings(n_atoms=12, n_nonzeros=2, n_rounds=30)

    learned = learn_dictionary([as_clip(signals)], settings)

    similarity = np.abs(learned.atoms @ atoms.T).max(axis=0)
    assert (similarity > 0.99).sum() >= 10


def test_each_round_reduces_the_error(rng):
    signals = rng.normal(size=(400, 8)) @ rng.normal(size=(8, 60))
    left = []
    for n_rounds in (1, 4, 12):
        settings = DictionarySettings(n_atoms=40, n_nonzeros=3, n_rounds=n_rounds)
        learned = learn_dictionary([as_clip(signals)], settings)
        codes = sparse_codes(signals, learned.atoms, 3)
        left.append(((signals - codes.signals(learned.atoms)) ** 2).sum())
        assert_allclose(np.linalg.norm(learned.atoms, axis=1), 1.0)

    assert left[0] > 1.05 * left[1] > 1.05 * left[2]


def test_single_atom_is_the_first_singular_vector(rng):
    """With one non-zero and two atoms with separate users, K-SVD is two rank-one fits."""
    a, b = rng.normal(size=(2, 50, 60)) * 0.05
    a[:, 0] += rng.uniform(1.0, 2.0, 50)
    b[:, 30] += rng.uniform(1.0, 2.0, 50)
    settings = DictionarySettings(n_atoms=2, n_nonzeros=1, seed=1)

    learned = learn_dictionary([as_clip(np.concatenate([a, b]))], settings)

    expected = [np.linalg.svd(part)[2][0] for part in (a, b)]
    assert_allclose(np.sort(np.abs(learned.atoms @ np.transpose(expected)).max(axis=0)), 1.0)


def test_centering_removes_the_mean(rng):
    signals = 5.0 + rng.normal(size=(100, 60))
    settings = DictionarySettings(n_atoms=10, n_nonzeros=3, centered=True)

    learned = learn_dictionary([as_clip(signals)], settings)

    assert_allclose(learned.mean, signals.mean(axis=0))
    moved = learn_dictionary([as_clip(signals + 3.0)], settings)
    assert_allclose(moved.atoms, learned.atoms, atol=1e-6)


def test_learning_repeats_and_does_not_modify_clips(rng):
    clips = [as_clip(rng.normal(size=(60, 60))) for _ in range(2)]
    before = clips[0].positions.copy()
    settings = DictionarySettings(n_atoms=20, n_nonzeros=3, n_rounds=2)

    one, same = (learn_dictionary(clips, settings) for _ in range(2))

    assert (one.atoms == same.atoms).all()
    assert (clips[0].positions == before).all()
    other = DictionarySettings(n_atoms=20, n_nonzeros=3, n_rounds=2, seed=3)
    assert not np.allclose(learn_dictionary(clips, other).atoms, one.atoms)


def test_clips_with_joints_never_observed_are_ignored(rng):
    complete, missing = rng.normal(size=(2, 60, 60))
    missing[:, 6:9] = np.nan
    settings = DictionarySettings(n_atoms=20, n_nonzeros=3, n_rounds=2)

    both = learn_dictionary([as_clip(missing), as_clip(complete)], settings)

    assert (both.atoms == learn_dictionary([as_clip(complete)], settings).atoms).all()
    with pytest.raises(InvalidMotionError, match="20 atoms cannot be learned from 0 complete"):
        learn_dictionary([as_clip(missing)], settings)


def test_missing_joints_do_not_change_the_chosen_atom(rng):
    """With one non-zero and half of the entries missing, the choice equals the complete one."""
    atoms = np.linalg.qr(rng.normal(size=(60, 60)))[0][:10]
    dictionary = PostureDictionary(atoms, np.zeros(60), 1)
    signals = 3.0 * atoms[rng.integers(10, size=40)]
    damaged = signals.reshape(40, 20, 3).copy()
    damaged[:, 10:] = np.nan

    codes = dictionary.codes(as_clip(damaged))

    assert (codes.atoms == dictionary.codes(as_clip(signals)).atoms).all()


def test_gaps_are_filled_and_joints_never_observed_reported():
    positions = np.zeros((5, 20, 3))
    positions[:, 2, 0] = [0.0, 1.0, np.nan, 3.0, np.nan]
    positions[:, 4] = np.nan

    signals, observed = observed_signals(positions)

    assert_allclose(signals[:, 6], [0.0, 1.0, 2.0, 3.0, 3.0])
    assert np.flatnonzero(~observed).tolist() == [12, 13, 14]
    assert not signals[:, 12].any()


def test_learning_can_be_cancelled(rng):
    def escape(fraction, message=""):
        raise SolveCancelled

    with pytest.raises(SolveCancelled):
        learn_dictionary(
            [as_clip(rng.normal(size=(60, 60)))],
            DictionarySettings(n_atoms=20, n_nonzeros=3),
            progress=escape,
        )
