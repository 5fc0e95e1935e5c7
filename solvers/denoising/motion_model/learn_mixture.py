"""Learn the mixture of windows by expectation maximization."""

from collections.abc import Sequence

import numpy as np
import scipy

from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import Motion
from ...progress import Progress, unwatched
from ..channels import encode
from .joint_groups import find_joint_groups
from .motion_mixture import N_CHANNELS, MotionMixture
from .principal_axes import principal_axes

WINDOW_FRAMES = 16
"""Frames of a window, of half a second at 30 Hz. Sweep on the development takes of the first
press: 24 are 1 % worse at one degree of noise."""
FRAME_RATE = 30.0
"""Hertz, by definition the rate of the patterns of Clean."""
HOP_FRAMES = 7
"""Frames from a window to the next."""
N_COMPONENTS = {1: 40, 2: 80}
"""Number of Gaussians, by that of joints. On the development takes of the first press 20 cost
1 % for joints, and 40 cost 0.3 % for pairs."""
N_ITERATIONS = 25
"""Updates of expectation maximization."""
MIN_MOVEMENT = 0.3
"""Degrees: joints whose channels all vary less (standard deviation over the take) stand
still. Chosen by hand; used in training only, so that no sweep varies it."""
RECORDING_NOISE = 0.05
"""Degrees: added to every covariance, since recordings are not free of noise. Chosen by hand;
used in training only, so that no sweep varies it."""
PRIOR_WINDOWS = 5.0
"""Number of windows without movement that every component has in addition to its own. Guards
components that few windows belong to."""
MIN_RESPONSIBILITY = 1e-4
"""Probability of a component below which a window does not count for its covariances. It bounds
the run time, which is a tenth of that with all windows."""


def extract_windows(motions: Sequence[Motion], n_joints: int = 1) -> Array:
    """Return the DCT coefficients of all moving joints, or of joints with their parents.

    Their movement is along common principal axes.

    Parameters
    ----------
    motions : sequence of Motion
        Complete, at FRAME_RATE; shorter ones than a window are left out.
    n_joints : int
        Joints that are looked at together.

    Returns
    -------
    shape (n_windows, 3 n_joints, WINDOW_FRAMES)
    """
    n_axes = N_CHANNELS * n_joints
    found = [np.zeros((0, n_axes, WINDOW_FRAMES))]
    for motion in motions:
        if motion.n_frames < WINDOW_FRAMES:
            continue
        channels = encode(motion, None)
        values, parents = channels.values, channels.parents
        assert parents is not None
        moves = values.std(axis=0).max(axis=-1) > MIN_MOVEMENT
        groups = find_joint_groups(parents, moves, n_joints)
        centered = (values - values.mean(axis=0))[:, groups]
        centered = centered.reshape(len(values), len(groups), n_axes)
        axes = principal_axes(centered, np.tile(np.eye(n_axes), (len(groups), 1, 1)))
        along_axes = np.einsum("tjc,jac->tja", centered, axes.from_channels)
        starts = np.arange(0, len(values) - WINDOW_FRAMES + 1, HOP_FRAMES)
        windows = np.stack([along_axes[start : start + WINDOW_FRAMES] for start in starts])
        coefficients = scipy.fft.dct(windows, axis=1, norm="ortho").transpose(0, 2, 3, 1)
        found.append(coefficients.reshape(-1, n_axes, WINDOW_FRAMES))
    return np.concatenate(found)


def learn_motion_mixture(
    motions: Sequence[Motion],
    n_joints: int = 1,
    *,
    max_windows: int = 60_000,
    n_components: int | None = None,
    trained_on: str = "",
    progress: Progress = unwatched,
) -> MotionMixture:
    """Fit a mixture of zero-mean Gaussians to the windows of moving joints.

    Components start with windows of equal energy, from the stillest to the fastest.

    Parameters
    ----------
    motions : sequence of Motion
        Complete, at FRAME_RATE.
    n_joints : int
        1 for joints, 2 for joints with their parents.
    max_windows : int
        Windows that are drawn, always the same ones.
    n_components : int, optional
        Without it, N_COMPONENTS.
    trained_on : str
        Description of the recordings.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        There are fewer windows than components.
    """
    n_components = n_components or N_COMPONENTS[n_joints]
    windows = extract_windows(motions, n_joints)
    if len(windows) < n_components:
        raise InvalidMotionError("The recordings are too short to learn from.")
    order = np.random.default_rng(0).permutation(len(windows))[:max_windows]
    windows = windows[order]
    ranks = np.argsort(np.argsort((windows**2).sum(axis=(1, 2))))
    responsibilities = np.zeros((len(windows), n_components))
    responsibilities[np.arange(len(windows)), ranks * n_components // len(windows)] = 1.0
    for iteration in range(N_ITERATIONS):
        progress(iteration / N_ITERATIONS, "Learning how joints move")
        weights = responsibilities.mean(axis=0)
        covariances = np.stack([_covariances(windows, own) for own in responsibilities.T])
        responsibilities = _responsibilities(windows, weights, covariances)
    return MotionMixture(weights, covariances, FRAME_RATE, trained_on)


def _covariances(windows: Array, responsibility: Array) -> Array:
    """Return the covariance of each axis of a component, shape (n_axes, window, window)."""
    counts = np.flatnonzero(responsibility > MIN_RESPONSIBILITY)
    own = windows[counts].transpose(1, 0, 2)
    products = (own * responsibility[counts, None]).transpose(0, 2, 1) @ own
    covariances = products / (responsibility[counts].sum() + PRIOR_WINDOWS)
    return np.asarray(covariances + RECORDING_NOISE**2 * np.eye(windows.shape[-1]))


def _responsibilities(windows: Array, weights: Array, covariances: Array) -> Array:
    """Return the probability of each component, shape (n_windows, n_components)."""
    factors = np.linalg.cholesky(covariances)
    log_scale = np.log(np.einsum("kaii->kai", factors).copy()).sum(axis=(1, 2))
    log_density = np.tile(np.log(weights) - log_scale, (len(windows), 1))
    for component, inverses in enumerate(np.linalg.inv(factors)):
        whitened = windows.transpose(1, 0, 2) @ inverses.transpose(0, 2, 1)
        log_density[:, component] -= 0.5 * (whitened**2).sum(axis=(0, 2))
    density = np.exp(log_density - log_density.max(axis=1, keepdims=True))
    return np.asarray(density / density.sum(axis=1, keepdims=True))
