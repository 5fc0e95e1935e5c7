"""The normal equations of a whole take, block by block of its frames, and their solution."""

from functools import cached_property

import numpy as np

from ..arrays import Array
from ..signals import lower_block_bands


class NormalEquations:
    """Weighted least squares whose residuals depend on up to three successive frames.

    The matrix is symmetric and banded, so the solution takes time in proportion to the number
    of frames.

    Parameters
    ----------
    n_frames, n_variables : int
        `n_variables` of each frame.
    """

    def __init__(self, n_frames: int, n_variables: int) -> None:
        self._shape = n_frames, n_variables
        self._of_frames: list[tuple[Array, Array]] = []
        self._of_steps: list[tuple[Array, Array, Array]] = []
        self._diagonal = np.zeros(n_variables)
        """Squared weights of the variables themselves."""
        self._second = np.zeros(n_variables)
        """Weights of second differences, whose part of the matrix is diagonal."""
        self._gradient = np.zeros((n_frames, n_variables))
        """Of what has a diagonal matrix."""
        self.cost = 0.0
        """Half the sum of the squares of all residuals."""

    def add_frames(self, residuals: Array, jacobian: Array) -> None:
        """Add residuals of single frames, (n_frames, n), with their derivatives.

        The derivatives have shape (n_frames, n, n_variables).
        """
        self._of_frames.append((residuals, jacobian))
        self._count(residuals)

    def add_steps(self, residuals: Array, before: Array, after: Array) -> None:
        """Add residuals of steps between frames, (n_frames - 1, n).

        `before` and `after` are their derivatives with respect to the variables of the earlier
        and the later frame, (n_frames - 1, n, n_variables).
        """
        self._of_steps.append((residuals, before, after))
        self._count(residuals)

    def add_variables(self, residuals: Array, weights: Array) -> None:
        """Add a residual of each variable, whose derivative is a weight, (n_variables,)."""
        self._diagonal += weights**2
        self._gradient += residuals * weights
        self._count(residuals)

    def add_second_differences(self, residuals: Array, weights: Array) -> None:
        """Add a residual for each second difference of a variable, (n_frames - 2, n_variables).

        Its derivatives are the weight of the variable times 1, -2 and 1.
        """
        n = len(residuals)
        for first, factor in enumerate((1.0, -2.0, 1.0)):
            self._gradient[first : first + n] += factor * residuals * weights
        self._second += weights**2
        self._count(residuals)

    def _count(self, residuals: Array) -> None:
        self.cost += 0.5 * float(np.vdot(residuals, residuals))

    @cached_property
    def _blocks_and_gradient(self) -> tuple[Array, Array, Array]:
        """Blocks of frames, blocks of a frame's rows and the next one's columns, gradient.

        All residuals together need one product of matrices for each frame.
        """
        n_frames, n = self._shape
        blocks, gradient = np.zeros((n_frames, n, n)), self._gradient.copy()
        between = np.zeros((n_frames - 1, n, n))
        blocks[:, np.arange(n), np.arange(n)] = self._diagonal
        if self._of_frames:
            residuals, jacobian = (
                np.concatenate(parts, axis=1) for parts in zip(*self._of_frames, strict=True)
            )
            blocks += jacobian.transpose(0, 2, 1) @ jacobian
            gradient += np.einsum("fn,fnv->fv", residuals, jacobian)
        if self._of_steps:
            residuals, before, after = (
                np.concatenate(parts, axis=1) for parts in zip(*self._of_steps, strict=True)
            )
            blocks[:-1] += before.transpose(0, 2, 1) @ before
            blocks[1:] += after.transpose(0, 2, 1) @ after
            between += before.transpose(0, 2, 1) @ after
            gradient[:-1] += np.einsum("fn,fnv->fv", residuals, before)
            gradient[1:] += np.einsum("fn,fnv->fv", residuals, after)
        return blocks, between, gradient

    @property
    def gradient(self) -> Array:
        """Derivatives of `cost`, (n_frames, n_variables)."""
        return self._blocks_and_gradient[2]

    @property
    def expected_decrease(self) -> float:
        """Decrease of `cost` by `step`, if the residuals were linear."""
        return -0.5 * float(np.vdot(self.gradient, self.step))

    @cached_property
    def step(self) -> Array:
        """The step to the least sum of squares, (n_frames, n_variables)."""
        from scipy.linalg import solveh_banded  # slow to import: only when needed

        blocks, between, gradient = self._blocks_and_gradient
        solved = solveh_banded(
            lower_block_bands(blocks, self._second, between),
            -gradient.ravel(),
            lower=True,
            overwrite_ab=True,
            check_finite=False,
        )
        return np.asarray(solved.reshape(gradient.shape))
