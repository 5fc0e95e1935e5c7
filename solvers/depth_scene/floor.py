"""Find the floor in pictures of depth, and with it where down is."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..progress import Progress, unwatched
from ..settings import Settings, setting
from .recording import DepthRecording

Array = NDArray[np.float64]

UP = np.array([0.0, -1.0, 0.0])
"""Of a camera that stands level, in its own frame."""
N_PICTURES, MOST_POINTS = 12, 6000
BESIDE, BESIDE_SQUARED = 0.015, 0.003
"""Metres from the plane, and metres per square metre of distance, as the noise grows."""
CLOSER = (1.0, 0.7, 0.5, 0.5)
"""Shares of the tolerance for each fit: first near, then without the feet of walls."""
BELOW = 3.0
"""Tolerances under the plane from which on a point speaks against it."""


@dataclass(frozen=True, kw_only=True)
class FloorSettings(Settings):
    """How the floor is looked for."""

    tilt: float = setting(
        40.0, "Largest tilt of the camera; higher also accepts slopes as floors",
        unit="degrees", minimum=1.0, maximum=80.0,
    )  # fmt: skip
    extent: float = setting(
        0.25,
        "Minimum spread of the visible floor in its narrow direction; higher rejects small"
        " patches", unit="m", minimum=0.01, maximum=10.0,
    )  # fmt: skip
    share: float = setting(
        0.03,
        "Minimum fraction of the visible points on the floor; higher rejects small patches",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    n_trials: int = setting(
        600, "Number of planes to try; more finds floors that are barely visible",
        minimum=1, maximum=100_000, advanced=True,
    )  # fmt: skip
    seed: int = setting(
        0, "Another seed tries other random points", minimum=0, maximum=2**31 - 1
    )


@dataclass(frozen=True, eq=False)
class Floor:
    """A plane in the frame of a camera.

    Attributes
    ----------
    up : float array, shape (3,)
        Unit vector against gravity.
    height : float, metres
        Of the camera above the floor.
    """

    up: Array
    height: float

    def heights(self, points: Array) -> Array:
        """Return how high points (..., 3) of the camera's frame are above the floor, metres."""
        return points @ self.up + self.height

    def world_from_camera(self) -> tuple[Array, Array]:
        """Return the turn (3, 3) and shift (3,) from the camera's frame to the world's.

        Z is up and 0 on the floor, below the camera is the origin, and the camera looks along
        +Y, so that an actor who faces it faces -Y.
        """
        forward = np.array([0.0, 0.0, 1.0])
        forward -= (forward @ self.up) * self.up
        forward /= np.linalg.norm(forward)
        turn = np.stack([np.cross(forward, self.up), forward, self.up])
        return turn, np.array([0.0, 0.0, self.height])


LEVEL = Floor(UP, 0.0)
"""Where no floor is seen: the camera is taken to stand level, and at height 0."""


def find_floor(
    recording: DepthRecording,
    settings: FloorSettings = FloorSettings(),
    *,
    progress: Progress = unwatched,
) -> Floor | None:
    """Find the floor in a recording: the largest plane that faces up with little beneath it.

    Planes through three random points [1]_ of pictures spread over the recording are tried.
    Those beside a plane, within the noise of a depth camera, speak for it; those beneath
    against it, as beneath a table. The plane of most votes is fitted to those beside it.

    Parameters
    ----------
    recording : DepthRecording
        With its background, or at least the floor around the feet.
    settings : FloorSettings
    progress : Progress

    Returns
    -------
    Floor or None
        None where no floor is seen, as in pictures cut out around the actor.

    References
    ----------
    .. [1] Fischler, Bolles (1981). Random sample consensus. Communications of the ACM 24(6).
       doi:10.1145/358669.358692
    """
    rng = np.random.default_rng(settings.seed)
    points = _points(recording, rng, progress)
    if len(points) < 3:
        return None
    plane = _best_plane(points, settings, rng)
    if plane is None:
        return None
    up, height = plane
    for share in CLOSER:
        beside = points[np.abs(points @ up + height) <= share * _tolerance(points)]
        if len(beside) < 3:
            return None
        up, height, spread = _fitted(beside)
    steep = float(up @ UP) < np.cos(np.radians(settings.tilt))
    if steep or spread < settings.extent or len(beside) < settings.share * len(points):
        return None
    return Floor(up, height)


def _points(recording: DepthRecording, rng: np.random.Generator, progress: Progress) -> Array:
    """Return points of some pictures, spread over the recording, shape (n, 3)."""
    n_pictures = min(N_PICTURES, recording.n_frames)
    frames = np.linspace(0, recording.n_frames - 1, n_pictures).round().astype(int)
    rays = recording.camera.rays()
    found = []
    for place, frame in enumerate(frames.tolist()):
        depth = recording.frame(frame)
        rows, columns = np.nonzero(depth)
        chosen = rng.permutation(len(rows))[: MOST_POINTS // n_pictures]
        rows, columns = rows[chosen], columns[chosen]
        found.append(rays[rows, columns] * depth[rows, columns, np.newaxis])
        progress((place + 1) / n_pictures, "Finding the floor")
    return np.concatenate(found)


def _best_plane(
    points: Array, settings: FloorSettings, rng: np.random.Generator
) -> tuple[Array, float] | None:
    one, two, three = points[rng.integers(len(points), size=(3, settings.n_trials))]
    normals = np.cross(two - one, three - one)
    lengths = np.linalg.norm(normals, axis=-1, keepdims=True)
    normals = np.where(normals @ UP < 0.0, -1.0, 1.0)[:, np.newaxis] * normals
    normals /= np.where(lengths > 0.0, lengths, np.inf)
    upright = normals @ UP > np.cos(np.radians(settings.tilt))
    normals, one = normals[upright], one[upright]
    if not len(normals):
        return None
    heights = -(normals * one).sum(axis=-1)
    above = (normals @ points.T + heights[:, np.newaxis]) / _tolerance(points)
    votes = (np.abs(above) <= 1.0).sum(axis=-1) - (above < -BELOW).sum(axis=-1)
    best = int(np.argmax(votes))
    return normals[best], float(heights[best])


def _tolerance(points: Array) -> Array:
    return np.asarray(BESIDE + BESIDE_SQUARED * points[..., 2] ** 2)


def _fitted(points: Array) -> tuple[Array, float, float]:
    """Return normal, height and narrower extent of the plane of least squares."""
    weights = _tolerance(points) ** -2
    middle = np.average(points, axis=0, weights=weights)
    spreads, axes = np.linalg.eigh(np.cov(points.T, aweights=weights))
    up = axes[:, 0] if axes[:, 0] @ UP > 0.0 else -axes[:, 0]
    return up, float(-up @ middle), float(np.sqrt(max(spreads[1], 0.0)))
