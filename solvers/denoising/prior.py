"""What is expected of the channels before a recording is seen: a Gaussian over windows."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .filter_bases import FilterBases, lag_products

Array = NDArray[np.float64]

SMOOTH_LENGTH = 3.0
"""Length, in frames, of the Gaussian correlation of what the bases cannot say."""
LEFT_OVER = 0.01
"""Share of the energy, per channel, that is always allowed beyond the bases."""


@dataclass(frozen=True, eq=False)
class WindowPrior:
    """Mean of each channel, and covariance of a window of all channels, frames outermost."""

    mean: Array
    covariance: Array
    window: int
    description: str

    def restricted(self, channels: NDArray[np.intp]) -> "WindowPrior":
        """Return the prior of some channels only."""
        n_channels = len(self.mean)
        columns = (np.arange(self.window)[:, None] * n_channels + channels).ravel()
        covariance = self.covariance[np.ix_(columns, columns)]
        return WindowPrior(self.mean[channels], covariance, self.window, self.description)


def prior_from_bases(bases: FilterBases, keys: tuple[str, ...]) -> WindowPrior | None:
    """Return the prior of these parts, all of which the bases must know; else None."""
    place = {key: index for index, key in enumerate(bases.keys)}
    if not all(key in place for key in keys):
        return None
    columns = np.concatenate([3 * place[key] + np.arange(3) for key in keys])
    patterns = bases.vectors[:, :, columns].reshape(len(bases.vectors), -1)
    covariance = (patterns.T * bases.values) @ patterns
    description = f"Patterns of {bases.n_clips} example clips."
    return WindowPrior(bases.mean[columns], covariance, bases.window, description)


def prior_from_take(takes: list[Array], window: int, noise: Array) -> WindowPrior:
    """Return a prior made from (roughly cleaned) channels of the take itself."""
    mean = np.concatenate(takes).mean(axis=0)
    n_windows = sum(len(take) - window + 1 for take in takes)
    total = sum(lag_products(take - mean, window) for take in takes)
    covariance = np.asarray(total) / max(n_windows, 1)
    # What white noise adds to the covariance stands on its diagonal only.
    covariance -= np.diag(np.tile(0.9 * noise**2, window))
    return WindowPrior(mean, covariance, window, "The take's own patterns.")


def with_smooth_rest(prior: WindowPrior) -> WindowPrior:
    """Allow every channel a little smooth movement that the patterns do not contain."""
    n_channels = len(prior.mean)
    steps = np.arange(prior.window)
    smooth = np.exp(-0.5 * (np.subtract.outer(steps, steps) / SMOOTH_LENGTH) ** 2)
    energy = np.maximum(np.diag(prior.covariance), 0.0)
    energy = energy.reshape(prior.window, n_channels).mean(axis=0)
    rest = LEFT_OVER * energy + 1e-4
    covariance = prior.covariance + np.kron(smooth, np.diag(rest))
    return WindowPrior(prior.mean, covariance, prior.window, prior.description)
