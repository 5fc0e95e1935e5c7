"""Orthogonal matching pursuit equals scikit-learn and exact cases."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from sklearn.linear_model import orthogonal_mp

from solvers.errors import InvalidSettingError
from solvers.retrieval.published.sparse_codes import sparse_codes


def unit(rows):
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def dense(codes, n_atoms):
    """Weights of all atoms, shape (n_signals, n_atoms)."""
    result = np.zeros((codes.n_signals, n_atoms))
    for row in range(codes.n_signals):
        np.add.at(result[row], codes.atoms[row], codes.weights[row])
    return result


@pytest.mark.parametrize(("n_atoms", "n_nonzeros"), [(40, 1), (40, 5), (200, 20), (700, 35)])
def test_codes_equal_those_of_scikit_learn(rng, n_atoms, n_nonzeros):
    atoms = unit(rng.normal(size=(n_atoms, 60)))
    signals = rng.normal(size=(30, 60))

    codes = sparse_codes(signals, atoms, n_nonzeros)

    reference = orthogonal_mp(atoms.T, signals.T, n_nonzero_coefs=n_nonzeros).T
    mine = dense(codes, n_atoms)
    assert_allclose((mine != 0).astype(int), (reference != 0).astype(int))
    assert_allclose(mine, reference, atol=1e-9)


def test_weights_are_least_squares_on_the_chosen_atoms(rng):
    atoms, signals = unit(rng.normal(size=(50, 12))), rng.normal(size=(9, 12))

    codes = sparse_codes(signals, atoms, 4)

    for signal, chosen, weights in zip(signals, codes.atoms, codes.weights, strict=True):
        assert_allclose(weights, np.linalg.lstsq(atoms[chosen].T, signal, rcond=None)[0])


def test_orthogonal_atoms_give_the_largest_products(rng):
    atoms = np.linalg.qr(rng.normal(size=(6, 6)))[0]
    weights = np.array([[0.1, -5.0, 0.2, 3.0, 0.0, -1.0]])

    codes = sparse_codes(weights @ atoms, atoms, 3)

    assert codes.atoms.tolist() == [[1, 3, 5]]
    assert_allclose(codes.weights, [[-5.0, 3.0, -1.0]])


def test_signal_of_few_atoms_has_zero_weights_elsewhere(rng):
    atoms = unit(rng.normal(size=(30, 20)))
    signals = 2.0 * atoms[[7]]

    codes = sparse_codes(signals, atoms, 5)

    assert codes.atoms[0, 0] == 7
    assert_allclose(codes.weights, [[2.0, 0, 0, 0, 0]], atol=1e-12)


def test_zero_signals_and_repeated_atoms_are_accepted(rng):
    atom = unit(rng.normal(size=(1, 5)))
    atoms = np.concatenate([atom, atom, unit(rng.normal(size=(2, 5))), np.zeros((1, 5))])

    codes = sparse_codes(np.concatenate([np.zeros((1, 5)), rng.normal(size=(3, 5))]), atoms, 4)

    assert np.isfinite(codes.weights).all()
    assert not codes.weights[0].any()
    # Two atoms are one direction and one is none: three can be used.
    assert ((codes.weights[1:] != 0.0).sum(axis=1) == 3).all()


@given(st.integers(1, 20), st.integers(0, 10**6))
def test_more_atoms_reduce_the_error(n_nonzeros, seed):
    rng = np.random.default_rng(seed)
    atoms, signals = unit(rng.normal(size=(35, 20))), rng.normal(size=(300, 20))

    codes = sparse_codes(signals, atoms, n_nonzeros)

    left = np.linalg.norm(signals - codes.signals(atoms), axis=1)
    if n_nonzeros > 1:
        fewer = sparse_codes(signals, atoms, n_nonzeros - 1)
        assert (left <= np.linalg.norm(signals - fewer.signals(atoms), axis=1) + 1e-9).all()
    separate = sparse_codes(signals[260:], atoms, n_nonzeros)
    assert_allclose(separate.weights, codes[slice(260, None)].weights, atol=1e-8)


def test_scaling_a_signal_scales_its_weights(rng):
    atoms, signals = unit(rng.normal(size=(35, 20))), rng.normal(size=(8, 20))
    before = signals.copy()

    small, large = (sparse_codes(scale * signals, atoms, 6) for scale in (1.0, -1000.0))

    assert_allclose(large.weights, -1000.0 * small.weights)
    assert_allclose(signals, before)


@pytest.mark.parametrize("n_nonzeros", [0, 21, 100])
def test_invalid_numbers_of_atoms_are_refused(rng, n_nonzeros):
    with pytest.raises(InvalidSettingError, match=f"^n_nonzeros is {n_nonzeros}"):
        sparse_codes(rng.normal(size=(2, 20)), unit(rng.normal(size=(35, 20))), n_nonzeros)
