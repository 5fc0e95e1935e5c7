"""Sparse Gaussian processes of all joints for one kind of step, evaluated together.

Inducing points, a subset of the examples, represent each channel (the projected process, or
DTC, of Quinonero-Candela, Rasmussen 2005, JMLR 6, section 4): its function is K(x, Z) v with
v ~ N(A^-1 K(Z, X) y, n A^-1), A = n K(Z, Z) + K(Z, X) K(X, Z). One draw of v is one draw of the
complete function, which returns to the mean of the outputs far from all examples.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from ...arrays import Array, Integers
from ...progress import Progress, unwatched
from .process import (
    N_CHANNELS,
    REGULARIZATION,
    Hyperparameters,
    compute_kernels,
    learn_hyperparameters,
)

N_INDUCING = 150
N_LEARNING = 120
"""Number of examples that hyperparameters are learned from."""
MIN_STD = 1e-6
"""Minimum of the standard deviations by which features and outputs are divided. It guards a
division."""
JITTER_STEPS = (0.0, 1e-12, 1e-10, 1e-8)
"""Fractions of the mean diagonal to add to it, tried in this order. They guard a Cholesky
factor."""
BATCH_SIZE = 500
"""Number of steps whose kernels are in memory together."""


@dataclass(frozen=True, eq=False)
class ProcessStack:
    """Processes of all triples; the first axis of every array is that of the triples.

    Attributes
    ----------
    columns : shape (n_triples, n_features)
        Feature columns of each triple; -1 is none.
    center, scale : shape (n_triples, n_features)
    middle, spread : shape (n_triples, 3)
        Mean and standard deviation of outputs.
    points : shape (n_triples, n_inducing, n_features)
    lengths, biases : shape (n_triples, 3)
    weights, mixing : shape (n_triples, 3, 3)
        Of each process in each channel; of each channel in each output.
    noises : shape (n_triples, 3)
        Variance of channels.
    mean : shape (n_triples, 3, n_inducing)
        Of v.
    posterior_factor : shape (n_triples, 3, n_inducing, n_inducing)
        R, with R R^T the covariance of v.
    inducing_inverse : shape (n_triples, 3, n_inducing, n_inducing)
        K(Z, Z)^-1.
    """

    columns: Integers
    center: Array
    scale: Array
    middle: Array
    spread: Array
    points: Array
    lengths: Array
    biases: Array
    weights: Array
    mixing: Array
    noises: Array
    mean: Array
    posterior_factor: Array
    inducing_inverse: Array

    def kernels(self, features: Array) -> Array:
        """Return K(x, Z) of all channels, shape (n_triples, 3, n, n_inducing).

        Parameters
        ----------
        features : shape (n, n_all_features)
        """
        scaled = self._scale_features(features)
        squared_distances = (scaled**2).sum(axis=-1)[..., None] + (self.points**2).sum(axis=-1)[
            :, None
        ]
        squared_distances -= 2.0 * scaled @ self.points.transpose(0, 2, 1)
        np.maximum(squared_distances, 0.0, out=squared_distances)
        kernels = np.exp(squared_distances[:, None] * (-0.5 / self.lengths**2)[..., None, None])
        kernels += self.biases[..., None, None]
        if (self.weights == np.eye(N_CHANNELS)).all():
            return np.asarray(kernels)
        return np.asarray(np.einsum("gcp,gpnm->gcnm", self.weights, kernels))

    def _scale_features(self, features: Array) -> Array:
        """Return the scaled features of each triple, shape (n_triples, n, n_features)."""
        used = np.where(self.columns >= 0, features[:, self.columns], 0.0).transpose(1, 0, 2)
        return np.asarray((used - self.center[:, None]) * self.scale[:, None])

    def outputs(self, channels: Array) -> Array:
        """Return outputs, shape (n, n_triples, 3), from channels, (n_triples, 3, n)."""
        mixed = np.matmul(self.mixing, channels).transpose(2, 0, 1)
        return np.asarray(mixed * self.spread + self.middle)

    def predict(self, features: Array) -> Array:
        """Return the predictive mean of the outputs, shape (n, n_triples, 3)."""
        parts = []
        for start in range(0, len(features), BATCH_SIZE):
            kernels = self.kernels(features[start : start + BATCH_SIZE])
            parts.append(self.outputs(np.einsum("gcnm,gcm->gcn", kernels, self.mean)))
        return np.concatenate(parts)

    def draw_outputs(self, features: Array, rng: np.random.Generator) -> Array:
        """Draw outputs from the predictive distribution, shape (n, n_triples, 3)."""
        kernels = self.kernels(features)
        prior = np.einsum("gcp,gp->gc", self.weights, 1.0 + self.biases)[..., None]
        explained = (np.matmul(kernels, self.inducing_inverse) * kernels).sum(axis=-1)
        posterior = (np.matmul(kernels, self.posterior_factor) ** 2).sum(axis=-1)
        variance = np.maximum(prior - explained, 0.0) + posterior + self.noises[..., None]
        mean = np.einsum("gcnm,gcm->gcn", kernels, self.mean)
        return self.outputs(mean + np.sqrt(variance) * rng.normal(size=mean.shape))

    def draw_functions(self, n: int, rng: np.random.Generator) -> Array:
        """Draw v of n functions, shape (n_triples, 3, n, n_inducing)."""
        white = rng.normal(size=(*self.mean.shape[:2], n, self.mean.shape[2]))
        return np.asarray(
            self.mean[:, :, None] + np.matmul(white, self.posterior_factor.swapaxes(-1, -2))
        )

    def evaluate_functions(self, features: Array, functions: Array) -> Array:
        """Return outputs of drawn functions, one per row, shape (n, n_triples, 3)."""
        return self.outputs((self.kernels(features) * functions).sum(axis=-1))


def learn_stack(
    features: Array,
    outputs: Array,
    columns: Integers,
    weights: Array,
    published: bool,
    hyperparameters: list[Hyperparameters] | None = None,
    progress: Progress = unwatched,
) -> tuple[ProcessStack, list[Hyperparameters]]:
    """Learn the processes of all triples, or only fit them to known hyperparameters.

    Parameters
    ----------
    features : shape (n, n_all_features)
    outputs : shape (n, n_triples, 3)
    columns : shape (n_triples, n_features)
    weights : shape (n_all_features,)
        Weight of each scaled feature.
    published : bool
    hyperparameters : list of Hyperparameters, optional
    progress : Progress
    """
    rng = np.random.default_rng(0)
    order = rng.permutation(len(features))
    inducing, learning = np.sort(order[:N_INDUCING]), np.sort(order[:N_LEARNING])
    spread = np.maximum(features.std(axis=0), MIN_STD)
    parts, learned = [], []
    for index, row in enumerate(columns):
        progress(index / len(columns), "Learning joints")
        is_used = row >= 0
        center = np.where(is_used, features.mean(axis=0)[row], 0.0)
        scale = np.where(is_used, (weights / spread)[row], 0.0)
        scaled = (np.where(is_used, features[:, row], 0.0) - center) * scale
        middle = outputs[:, index].mean(axis=0)
        largest = max(float(outputs[:, index].std(axis=0).max()), MIN_STD)
        targets = (outputs[:, index] - middle) / largest
        parameters = hyperparameters[index] if hyperparameters else learn_hyperparameters(
            scaled[learning], targets[learning], published
        )  # fmt: skip
        learned.append(parameters)
        fitted = _fit_processes(scaled, targets, scaled[inducing], parameters, published)
        parts.append((
            row,
            center,
            scale,
            middle,
            np.full(N_CHANNELS, largest),
            scaled[inducing],
            *fitted,
        ))
    return ProcessStack(*(np.stack(part) for part in zip(*parts, strict=True))), learned


def _robust_cholesky(matrix: Array) -> Array:
    """Return the lower factor of a matrix that rounding may have made indefinite.

    Clips that repeat the same frames produce kernels with repeated rows.
    """
    mean_diagonal = np.trace(matrix) / len(matrix)
    for fraction in JITTER_STEPS:
        try:
            return np.linalg.cholesky(matrix + fraction * mean_diagonal * np.eye(len(matrix)))
        except np.linalg.LinAlgError:
            continue
    return np.linalg.cholesky(matrix + REGULARIZATION * mean_diagonal * np.eye(len(matrix)))


def _fit_processes(
    scaled: Array,
    targets: Array,
    points: Array,
    hyperparameters: Hyperparameters,
    published: bool,
) -> tuple[Array, ...]:
    """Return lengths, biases, weights, mixing, noises, mean, R and K(Z, Z)^-1."""
    weights, mixing = (
        hyperparameters.weights(published),
        hyperparameters.from_channels(published),
    )
    noises = weights @ hyperparameters.noises + REGULARIZATION
    channels = np.linalg.solve(mixing, targets.T)
    among = compute_kernels(
        scipy.spatial.distance.cdist(points, points, "sqeuclidean"), hyperparameters, weights
    )
    across = compute_kernels(
        scipy.spatial.distance.cdist(points, scaled, "sqeuclidean"), hyperparameters, weights
    )
    means, roots, inverses = [], [], []
    eye = np.eye(len(points))
    for own_kernel, cross_kernel, noise, targets_of_channel in zip(
        among, across, noises, channels, strict=True
    ):
        regularized = own_kernel + REGULARIZATION * np.trace(own_kernel) / len(own_kernel) * eye
        lower = _robust_cholesky(noise * regularized + cross_kernel @ cross_kernel.T)
        means.append(scipy.linalg.cho_solve((lower, True), cross_kernel @ targets_of_channel))
        roots.append(np.sqrt(noise) * scipy.linalg.solve_triangular(lower, eye, lower=True).T)
        inverses.append(np.linalg.inv(regularized))
    return (
        hyperparameters.lengths, hyperparameters.biases, weights, mixing, noises,
        np.stack(means), np.stack(roots), np.stack(inverses),
    )  # fmt: skip
