"""Foretell a lost point from its companions: Gaussian processes over pose and time."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dpotrf, dpotri

from .blend_estimates import blend_weights
from .reference_markers import SLACK, Companions, body_frames

Array = NDArray[np.float64]

VARIANTS = ((3, 8), (3, 16), (8, 24), (3, 5), (5, 12))
"""Numbers of companions that span the frame, and that tell the pose."""


class Kernel(NamedTuple):
    """How alike two moments are; variances relative to that of the point in its frame."""

    linear: float
    similar: float
    reach: float
    """Of similar poses, relative to the usual distance of two poses."""
    steady: float
    seconds: float
    """For which the part that does not depend on the pose lasts."""
    unexplained: float


KERNELS = (
    Kernel(1.0, 0.0, 1.0, 0.01, 0.3, 1e-3),
    Kernel(1.0, 0.3, 1.0, 0.01, 0.3, 1e-2),
    Kernel(1.0, 0.3, 0.5, 0.01, 0.1, 3e-2),
    Kernel(0.05, 0.02, 1.0, 0.02, 0.1, 1e-2),
    Kernel(1.0, 1.0, 2.0, 0.1, 0.03, 1e-4),
    Kernel(1.0, 1.0, 2.0, 0.1, 0.1, 1e-4),
)
TINY = 1e-9
"""Square metres: what is nearer than 0.03 mm is the same."""


class Foretold(NamedTuple):
    """A point foretold, metres."""

    places: Array
    """Shape (n_frames, 3), learned frames first, then those of the gap."""
    trial: Array
    """Error where frames that were learned are left out by stretches as long as the gap,
    shape (n_learned, 3)."""
    depth: Array
    """Frames that each of these was from the end of its stretch, shape (n_learned,)."""


class Problem(NamedTuple):
    """One choice of frame and pose, ready for any kernel."""

    wanted: Array
    """The point in the frame, relative to its mean, shape (n_learned, 3)."""
    mean: Array
    turns: Array
    origins: Array
    products: Array
    """Of all poses with all learned ones, shape (n_frames, n_learned)."""
    square_distances: Array
    seconds_apart: Array


def foretell(
    positions: Array, point: int, companions: Companions, frame_rate: float, length: int
) -> Foretold:
    """Average what several frames and kernels foretell, by how they fare when tried.

    In a frame that travels with its companions, a point is a smooth function of their pose
    (linear, and alike for similar poses), and of time. Averaging such estimates follows Tits,
    Tilmanne and Dutoit [1]_; they are weighted by what they get wrong in whole stretches left
    out, which is exact without solving again: K_BB^-1 (K^-1 y)_B, of the inverse's block [2]_.

    Parameters
    ----------
    positions : shape (n_frames, n_points, 3), metres
    point : int
    companions : Companions
        Whose `learned` and `foretold` frames are used, all of them.
    frame_rate : float, hertz
    length : int
        Frames of the gap.

    References
    ----------
    .. [1] Tits, Tilmanne, Dutoit (2018). Robust and automatic motion-capture data recovery
       using soft skeleton constraints and model averaging. doi:10.1371/journal.pone.0199744
    .. [2] Rasmussen, Williams (2006). Gaussian Processes for Machine Learning, 5.4.2.
    """
    rows = np.concatenate([companions.learned, companions.foretold])
    poses = positions[np.ix_(rows, companions.points)]
    truth = positions[companions.learned, point]
    stretches, depth = _stretches(companions.learned, length)
    found, trials = [], []
    for spanning, telling in _variants(len(companions.points)):
        weights = 1.0 / (companions.slack**2 + SLACK**2)
        problem = _problem(
            poses[:, :telling], truth, weights[:telling], spanning, rows / frame_rate
        )
        for kernel in KERNELS:
            local, error = _solved(problem, kernel, stretches)
            turned = np.einsum("fij,fj->fi", problem.turns, local + problem.mean)
            found.append(turned + problem.origins)
            trials.append(np.einsum("fij,fj->fi", problem.turns[: len(error)], error))
    weights = blend_weights(trials)
    places = np.tensordot(weights, found, 1)
    return Foretold(places, np.tensordot(weights, trials, 1), depth)


def _variants(n_companions: int) -> list[tuple[int, int]]:
    """Return the variants that differ with so many companions."""
    possible = [
        (min(spanning, n_companions), min(telling, n_companions))
        for spanning, telling in VARIANTS
    ]
    return list(dict.fromkeys(possible))


def _problem(
    places: Array, truth: Array, weights: Array, spanning: int, seconds: Array
) -> Problem:
    n_learned = len(truth)
    turns, origins = body_frames(places[:, :spanning], weights[:spanning])
    local = np.einsum("fij,fi->fj", turns[:n_learned], truth - origins[:n_learned])
    pose = np.einsum("fij,fpi->fpj", turns, places - origins[:, None])
    pose -= pose[:n_learned].mean(axis=0)
    pose = (pose * np.sqrt(weights)[:, None]).reshape(len(pose), -1)
    pose /= np.sqrt((pose[:n_learned] ** 2).sum(axis=1).mean() + TINY)
    products = pose @ pose[:n_learned].T
    sizes = (pose**2).sum(axis=1)
    squares = np.maximum(sizes[:, None] + sizes[:n_learned] - 2.0 * products, 0.0)
    mean = local.mean(axis=0)
    apart = np.abs(seconds[:, None] - seconds[:n_learned])
    return Problem(local - mean, mean, turns, origins, products, squares, apart)


def _solved(
    problem: Problem, kernel: Kernel, stretches: list[NDArray[np.intp]]
) -> tuple[Array, Array]:
    """Return what is foretold in all frames, and the errors of stretches left out."""
    wanted, n_learned = problem.wanted, len(problem.wanted)
    alike = kernel.linear * problem.products
    if kernel.similar:
        alike += kernel.similar * np.exp(problem.square_distances / (-2.0 * kernel.reach**2))
    alike += kernel.steady * matern(problem.seconds_apart / kernel.seconds)
    unexplained = kernel.unexplained + TINY / ((wanted**2).mean() + TINY)
    inverse = _inverse(alike[:n_learned] + unexplained * np.eye(n_learned))
    gain = inverse @ wanted
    error = np.zeros_like(wanted)
    for stretch in stretches:
        error[stretch] = np.linalg.solve(inverse[np.ix_(stretch, stretch)], gain[stretch])
    return alike @ gain, error


def matern(steps: Array) -> Array:
    """Return the Matern covariance of smoothness 5/2, of which the square root of 5 is left out
    of the unit of distance."""
    return np.asarray((1.0 + steps + steps**2 / 3.0) * np.exp(-steps))


def _inverse(matrix: Array) -> Array:
    lower, _ = dpotrf(matrix, lower=1, clean=1, overwrite_a=1)
    inverse = dpotri(lower, lower=1, overwrite_c=1)[0]
    return np.asarray(inverse + np.tril(inverse, -1).T)


def _stretches(frames: NDArray[np.intp], length: int) -> tuple[list[NDArray[np.intp]], Array]:
    """Sort learned frames into stretches of the gap's length, at least two of them."""
    length = max(min(length, (int(np.ptp(frames)) + 1) // 2), 1)
    number, place = np.divmod(frames - frames[0], length)
    depth = np.minimum(place + 1, length - place)
    return [np.flatnonzero(number == each) for each in np.unique(number)], depth.astype(float)
