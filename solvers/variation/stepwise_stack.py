"""The sparse Gaussian processes of all joints for one kind of step, evaluated together.

Each channel is told by its values at inducing points, a subset of the examples (the projected
process, or DTC, of Quinonero-Candela, Rasmussen 2005, JMLR 6, section 4): its function is
K(x, Z) v with v ~ N(A^-1 K(Z, X) y, n A^-1), A = n K(Z, Z) + K(Z, X) K(X, Z). One draw of v is
one draw of the whole function, which returns to the mean of the outputs far from all examples.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_solve, solve_triangular
from scipy.spatial.distance import cdist

from ..progress import Progress, unwatched
from .stepwise_process import JITTER, Hyperparameters, N, kernel_of, learn_hyperparameters

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

N_INDUCING = 150
N_LEARNING = 120
"""Examples that hyper-parameters are learned on."""
TINY = 1e-6
EXTRA = (0.0, 1e-12, 1e-10, 1e-8)
"""Parts of the mean of a diagonal that are added to it where they have to be."""
AT_ONCE = 500
"""Steps whose kernels are held in memory together."""


@dataclass(frozen=True, eq=False)
class ProcessStack:
    """Processes of all triples; the first axis of every array is that of the triples.

    Attributes
    ----------
    columns : shape (n_triples, n_features)
        Which features each sees; -1 is none.
    center, scale : shape (n_triples, n_features)
    middle, spread : shape (n_triples, 3)
        Of outputs.
    points : shape (n_triples, n_inducing, n_features)
    lengths, biases : shape (n_triples, 3)
    weights, mixing : shape (n_triples, 3, 3)
        Of each process in each channel; of each channel in each output.
    noises : shape (n_triples, 3)
        Variance of channels.
    mean : shape (n_triples, 3, n_inducing)
        Of v.
    root : shape (n_triples, 3, n_inducing, n_inducing)
        With R R^T the covariance of v.
    known : shape (n_triples, 3, n_inducing, n_inducing)
        K(Z, Z)^-1.
    """

    columns: Indices
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
    root: Array
    known: Array

    def kernels(self, features: Array) -> Array:
        """Return K(x, Z) of all channels, shape (n_triples, 3, n, n_inducing).

        Parameters
        ----------
        features : shape (n, n_all_features)
        """
        seen = self._scaled(features)
        far = (seen**2).sum(axis=-1)[..., None] + (self.points**2).sum(axis=-1)[:, None]
        far -= 2.0 * seen @ self.points.transpose(0, 2, 1)
        np.maximum(far, 0.0, out=far)
        each = np.exp(far[:, None] * (-0.5 / self.lengths**2)[..., None, None])
        each += self.biases[..., None, None]
        if (self.weights == np.eye(N)).all():
            return np.asarray(each)
        return np.asarray(np.einsum("gcp,gpnm->gcnm", self.weights, each))

    def _scaled(self, features: Array) -> Array:
        """Return what each triple sees, shape (n_triples, n, n_features)."""
        seen = np.where(self.columns >= 0, features[:, self.columns], 0.0).transpose(1, 0, 2)
        return np.asarray((seen - self.center[:, None]) * self.scale[:, None])

    def outputs(self, channels: Array) -> Array:
        """Return outputs, shape (n, n_triples, 3), of channels, (n_triples, 3, n)."""
        mixed = np.matmul(self.mixing, channels).transpose(2, 0, 1)
        return np.asarray(mixed * self.spread + self.middle)

    def expected(self, features: Array) -> Array:
        """Return the mean of the outputs, shape (n, n_triples, 3)."""
        parts = []
        for start in range(0, len(features), AT_ONCE):
            kernels = self.kernels(features[start : start + AT_ONCE])
            parts.append(self.outputs(np.einsum("gcnm,gcm->gcn", kernels, self.mean)))
        return np.concatenate(parts)

    def sampled(self, features: Array, rng: np.random.Generator) -> Array:
        """Return outputs drawn from the predictive distribution, shape (n, n_triples, 3)."""
        kernels = self.kernels(features)
        prior = np.einsum("gcp,gp->gc", self.weights, 1.0 + self.biases)[..., None]
        open_part = (np.matmul(kernels, self.known) * kernels).sum(axis=-1)
        told = (np.matmul(kernels, self.root) ** 2).sum(axis=-1)
        variance = np.maximum(prior - open_part, 0.0) + told + self.noises[..., None]
        mean = np.einsum("gcnm,gcm->gcn", kernels, self.mean)
        return self.outputs(mean + np.sqrt(variance) * rng.normal(size=mean.shape))

    def draw_functions(self, n: int, rng: np.random.Generator) -> Array:
        """Return v of n functions, shape (n_triples, 3, n, n_inducing)."""
        white = rng.normal(size=(*self.mean.shape[:2], n, self.mean.shape[2]))
        return np.asarray(self.mean[:, :, None] + np.matmul(white, self.root.swapaxes(-1, -2)))

    def followed(self, features: Array, functions: Array) -> Array:
        """Return outputs by functions drawn, one for each row, shape (n, n_triples, 3)."""
        return self.outputs((self.kernels(features) * functions).sum(axis=-1))


def learn_stack(
    features: Array,
    outputs: Array,
    columns: Indices,
    weights: Array,
    published: bool,
    found: list[Hyperparameters] | None = None,
    progress: Progress = unwatched,
) -> tuple[ProcessStack, list[Hyperparameters]]:
    """Learn the processes of all triples, or only fit them to hyper-parameters known before.

    Parameters
    ----------
    features : shape (n, n_all_features)
    outputs : shape (n, n_triples, 3)
    columns : shape (n_triples, n_features)
    weights : shape (n_all_features,)
        How much each feature counts once it is scaled.
    published : bool
    found : list of Hyperparameters, optional
    progress : Progress
    """
    rng = np.random.default_rng(0)
    order = rng.permutation(len(features))
    inducing, learning = np.sort(order[:N_INDUCING]), np.sort(order[:N_LEARNING])
    spread = np.maximum(features.std(axis=0), TINY)
    parts, learned = [], []
    for place, row in enumerate(columns):
        progress(place / len(columns), "Learning joints")
        there = row >= 0
        center = np.where(there, features.mean(axis=0)[row], 0.0)
        scale = np.where(there, (weights / spread)[row], 0.0)
        seen = (np.where(there, features[:, row], 0.0) - center) * scale
        middle = outputs[:, place].mean(axis=0)
        largest = max(float(outputs[:, place].std(axis=0).max()), TINY)
        wanted = (outputs[:, place] - middle) / largest
        known = found[place] if found else learn_hyperparameters(
            seen[learning], wanted[learning], published
        )  # fmt: skip
        learned.append(known)
        fitted = _fitted(seen, wanted, seen[inducing], known, published)
        parts.append((row, center, scale, middle, np.full(N, largest), seen[inducing], *fitted))
    return ProcessStack(*(np.stack(part) for part in zip(*parts, strict=True))), learned


def _cholesky(matrix: Array) -> Array:
    """Return the lower factor of a matrix that rounding may have made indefinite.

    Of clips in which the same frames come again and again, the kernels' rows are the same too.
    """
    usual = np.trace(matrix) / len(matrix)
    for part in EXTRA:
        try:
            return np.linalg.cholesky(matrix + part * usual * np.eye(len(matrix)))
        except np.linalg.LinAlgError:
            continue
    return np.linalg.cholesky(matrix + JITTER * usual * np.eye(len(matrix)))


def _fitted(
    seen: Array, wanted: Array, points: Array, found: Hyperparameters, published: bool
) -> tuple[Array, ...]:
    """Return lengths, biases, weights, mixing, noises, mean, root and K(Z, Z)^-1."""
    weights, mixing = found.weights(published), found.from_channels(published)
    noises = weights @ found.noises + JITTER
    channels = np.linalg.solve(mixing, wanted.T)
    among = kernel_of(cdist(points, points, "sqeuclidean"), found, weights)
    across = kernel_of(cdist(points, seen, "sqeuclidean"), found, weights)
    means, roots, knowns = [], [], []
    eye = np.eye(len(points))
    for own, other, noise, told in zip(among, across, noises, channels, strict=True):
        steady = own + JITTER * np.trace(own) / len(own) * eye
        lower = _cholesky(noise * steady + other @ other.T)
        means.append(cho_solve((lower, True), other @ told))
        roots.append(np.sqrt(noise) * solve_triangular(lower, eye, lower=True).T)
        knowns.append(np.linalg.inv(steady))
    return (
        found.lengths, found.biases, weights, mixing, noises,
        np.stack(means), np.stack(roots), np.stack(knowns),
    )  # fmt: skip
