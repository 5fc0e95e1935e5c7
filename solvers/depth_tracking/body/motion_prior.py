"""Motion prior: local principal components of the successors of similar recorded poses."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from ...archives import ArchiveLayout
from ...arrays import Array
from ...errors import InvalidFileError, InvalidMotionError
from ...npz_members import Values, integers, words
from .coordinates import COORDINATES, N_COORDINATES, N_ROOT
from .normal_equations import PoseEquations

LAYOUT = ArchiveLayout(
    "motion prior",
    1,
    {
        "poses": Values("f", ("poses", len(COORDINATES) - N_ROOT)),
        "clips": integers("poses", minimum=0, maximum=2**31 - 1),
        "trained_on": words(optional=True),
        "coordinates": words("coordinates"),
    },
    holds="a damaged prior",
    remedy="Learn it again.",
)
SHIPPED = Path(__file__).parent / "motions.npz"
N_NEIGHBORS, N_FOLLOWING, EXPLAINED_VARIANCE = 50, 3, 0.95
"""K, w and the fraction of variance kept, of [LOU12] section 3.5."""


@dataclass(frozen=True, eq=False)
class MotionPrior:
    """Poses of recorded motions, in order, without root position and rotation.

    Attributes
    ----------
    poses : shape (n_poses, 30)
        The joint coordinates of every frame.
    clips : int, shape (n_poses,)
        Motion index of each pose, ascending.
    trained_on : str
        Description of the motions.
    """

    poses: Array
    clips: NDArray[np.intp]
    trained_on: str = ""

    @cached_property
    def tree(self) -> Any:
        """Search tree of the poses."""
        return scipy.spatial.cKDTree(self.poses)

    def save(self, path: Path | str) -> None:
        """Write an archive that `load_motion_prior` reads."""
        arrays: dict[str, NDArray[Any]] = {
            "poses": self.poses.astype(np.float16), "clips": self.clips.astype(np.int32),
            "trained_on": np.array(self.trained_on),
            "coordinates": np.array(COORDINATES[N_ROOT:]),
        }  # fmt: skip
        LAYOUT.write(path, arrays)


def load_motion_prior(path: Path | str = SHIPPED) -> MotionPrior:
    """Read what `MotionPrior.save` wrote; without a path, the prior that is shipped.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds something else.
    """
    arrays = LAYOUT.read(path)
    if tuple(arrays["coordinates"].tolist()) != COORDINATES[N_ROOT:]:
        raise InvalidFileError(f"{path} holds a prior for other body parts. Learn it again.")
    poses, clips = arrays["poses"], arrays["clips"].astype(np.intp)
    if not len(poses) or (np.diff(clips) < 0).any():
        raise LAYOUT.damaged(path, "its clips are not in ascending order")
    return MotionPrior(poses.astype(np.float64), clips, str(arrays.get("trained_on", "")))


def motion_prior_from_poses(sequences: Sequence[Array], trained_on: str = "") -> MotionPrior:
    """Return the prior of sequences of poses, each of shape (n_frames, 36).

    Raises
    ------
    InvalidMotionError
        The sequences have no pose.
    """
    if not sum(len(sequence) for sequence in sequences):
        raise InvalidMotionError("There is no pose to learn from; choose recorded motions.")
    clips = np.repeat(np.arange(len(sequences)), [len(sequence) for sequence in sequences])
    return MotionPrior(np.concatenate(sequences)[:, N_ROOT:], clips, trained_on)


@dataclass(frozen=True, eq=False)
class LocalPca:
    """A linear subspace of likely next poses.

    Attributes
    ----------
    mean : shape (30,)
    basis : shape (30, n_components)
        Orthonormal.
    """

    mean: Array
    basis: Array

    def equations(self, pose: Array, weight: float) -> PoseEquations:
        """Return equations that pull a pose (36,) to the subspace [LOU12] eq. 3.12, 3.13."""
        projection = np.eye(len(self.mean)) - self.basis @ self.basis.T
        deviation = projection @ (pose[N_ROOT:] - self.mean)
        matrix, vector = np.zeros((N_COORDINATES, N_COORDINATES)), np.zeros(N_COORDINATES)
        matrix[N_ROOT:, N_ROOT:], vector[N_ROOT:] = weight * projection, -weight * deviation
        return PoseEquations(matrix, vector, 0.5 * weight * float(deviation @ deviation))


def local_pca(prior: MotionPrior, pose: Array) -> LocalPca:
    """Return the subspace of the poses that followed the most similar recorded ones.

    `pose` (36,) is the pose of the previous frame. The method collects the `N_FOLLOWING` poses
    after each of its `N_NEIGHBORS` nearest poses. It keeps the principal components that hold
    the fraction `EXPLAINED_VARIANCE` of their variance [LOU12]_.

    References
    ----------
    .. [LOU12] Lou (2012). Acquiring 3D full-body motion from noisy and ambiguous input. PhD
       dissertation, Texas A&M University, section 3.5.
    """
    n_neighbors = min(N_NEIGHBORS, len(prior.poses))
    _, nearest = prior.tree.query(pose[N_ROOT:], k=n_neighbors)
    successors = following_poses(prior, np.atleast_1d(nearest))
    mean = successors.mean(axis=0)
    values, vectors = np.linalg.eigh(np.cov(successors.T, bias=True))
    explained = np.cumsum(values[::-1]) / max(values.sum(), 1e-300)
    n_components = int(np.searchsorted(explained, EXPLAINED_VARIANCE)) + 1
    return LocalPca(mean, vectors[:, ::-1][:, :n_components])


def following_poses(prior: MotionPrior, indices: NDArray[np.intp]) -> Array:
    """Return the next `N_FOLLOWING` poses (n, 30) after each index within its clip.

    If none follows, return the poses themselves.
    """
    following = (indices[:, np.newaxis] + np.arange(1, N_FOLLOWING + 1)).ravel()
    clips = np.repeat(prior.clips[indices], N_FOLLOWING)
    inside = following < len(prior.poses)
    inside[inside] = prior.clips[following[inside]] == clips[inside]
    successors: Array = prior.poses[following[inside]] if inside.any() else prior.poses[indices]
    return successors
