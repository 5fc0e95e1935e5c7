"""Average several estimates so that their errors cancel."""

import numpy as np
from scipy.optimize import minimize

from solvers.denoising.marker_gaps.blend_estimates import INDEPENDENT_FRACTION, blend_weights

N_FRAMES = 4000


def errors(*sizes):
    rng = np.random.default_rng(3)
    return [size * rng.normal(size=(N_FRAMES, 3)) for size in sizes]


def test_independent_estimates_have_weights_of_inverse_squared_errors():
    weights = blend_weights(errors(0.01, 0.02, 0.04))

    expected = np.array([16.0, 4.0, 1.0]) / 21.0
    assert np.allclose(weights, expected, atol=0.02)
    assert np.isclose(weights.sum(), 1.0)


def test_weights_equal_those_of_a_general_minimization():
    first, second, third = errors(0.01, 0.02, 0.005)
    trials = [first, first + second, third + 0.8 * first]
    flat = np.array(trials).reshape(3, -1)
    products = flat @ flat.T / N_FRAMES
    products += INDEPENDENT_FRACTION * np.diag(np.diag(products))
    minimum = minimize(
        lambda weights: 1e4 * weights @ products @ weights,
        np.full(3, 1.0 / 3.0),
        bounds=[(0.0, 1.0)] * 3,
        constraints={"type": "eq", "fun": lambda weights: weights.sum() - 1.0},
        options={"ftol": 1e-12},
    )

    assert np.allclose(blend_weights(trials), minimum.x, atol=2e-3)


def test_errors_of_opposite_sign_cancel():
    shared, own = errors(0.02, 0.002)

    trials = [shared, own - shared, 3.0 * shared]
    blended = np.tensordot(blend_weights(trials), trials, 1)

    assert np.abs(blended).mean() < 0.1 * np.abs(shared).mean()


def test_worse_copy_has_no_weight_and_equal_estimates_have_equal_weights():
    (error,) = errors(0.01)

    assert np.allclose(blend_weights([error, error]), 0.5)
    assert np.allclose(blend_weights([error, 4.0 * error]), [1.0, 0.0], atol=1e-3)


def test_estimates_without_error_have_equal_weights():
    assert np.allclose(blend_weights([np.zeros((5, 3))] * 3), 1.0 / 3.0)
