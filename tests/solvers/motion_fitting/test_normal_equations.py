"""The banded normal equations have the solution of the dense least-squares problem."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion_fitting.normal_equations import NormalEquations

N = 4


class DenseProblem:
    """The same residuals as rows of one dense matrix."""

    def __init__(self, n_frames: int) -> None:
        self.n_frames, self.rows, self.residuals = n_frames, [], []

    def add(self, residual: float, **derivatives) -> None:
        """Add a row, by derivatives with respect to frames: `f3=...`."""
        row = np.zeros((self.n_frames, N))
        for frame, derivative in derivatives.items():
            row[int(frame[1:])] = derivative
        self.rows.append(row.ravel())
        self.residuals.append(residual)

    def step(self) -> np.ndarray:
        found = np.linalg.lstsq(np.array(self.rows), -np.array(self.residuals), rcond=None)
        return found[0].reshape(self.n_frames, N)


def both(rng, n_frames: int) -> tuple[NormalEquations, DenseProblem]:
    """Return random residuals of all kinds in both forms."""
    banded, dense = NormalEquations(n_frames, N), DenseProblem(n_frames)
    residuals, jacobian = rng.normal(size=(n_frames, 3)), rng.normal(size=(n_frames, 3, N))
    banded.add_frames(residuals, jacobian)
    for frame, row in np.ndindex(n_frames, 3):
        dense.add(residuals[frame, row], **{f"f{frame}": jacobian[frame, row]})
    residuals = rng.normal(size=(n_frames - 1, 2))
    before, after = rng.normal(size=(2, n_frames - 1, 2, N))
    banded.add_steps(residuals, before, after)
    for frame, row in np.ndindex(n_frames - 1, 2):
        steps = {f"f{frame}": before[frame, row], f"f{frame + 1}": after[frame, row]}
        dense.add(residuals[frame, row], **steps)
    weights, residuals = rng.uniform(0.5, 2.0, N), rng.normal(size=(n_frames, N))
    banded.add_variables(residuals, weights)
    for frame, variable in np.ndindex(n_frames, N):
        dense.add(residuals[frame, variable], **{f"f{frame}": weights * np.eye(N)[variable]})
    residuals = rng.normal(size=(max(n_frames - 2, 0), N))
    banded.add_second_differences(residuals, weights)
    for frame, variable in np.ndindex(*residuals.shape):
        unit = weights * np.eye(N)[variable]
        second = {f"f{frame}": unit, f"f{frame + 1}": -2.0 * unit, f"f{frame + 2}": unit}
        dense.add(residuals[frame, variable], **second)
    return banded, dense


@pytest.mark.parametrize("n_frames", [1, 2, 3, 12])
def test_step_is_that_of_dense_least_squares(rng, n_frames):
    banded, dense = both(rng, n_frames)

    assert_allclose(banded.step, dense.step(), atol=1e-9)


def test_cost_is_half_the_sum_of_squares(rng):
    banded, dense = both(rng, 6)

    assert banded.cost == pytest.approx(0.5 * np.sum(np.square(dense.residuals)))
