"""Find the floor plane in depth images, and the vertical direction with it."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..progress import Progress, unwatched
from ..settings import Settings, setting
from .recording import DepthRecording

LEVEL_UP = np.array([0.0, -1.0, 0.0])
"""Up direction in the frame of a level camera."""
MAX_IMAGES, MAX_POINTS = 12, 6000
"""Number of images, evenly spaced, and of their points together that the plane is fitted to.
They bound the run time. Half and twice are no better (`make sensitivity`)."""
TOLERANCE_M = 0.015
"""Inlier distance from the plane, meters. Chosen by hand; `make sensitivity` varies it."""
TOLERANCE_PER_M2 = 0.003
"""Growth of that distance with squared depth: two standard deviations of the noise of a Kinect,
0.04 m at 5 m (Khoshelham and Elberink 2012, doi:10.3390/s120201437)."""
FIT_TOLERANCES = (1.0, 0.7, 0.5, 0.5)
"""Fraction of the tolerance for each refit; the last ones exclude the base of walls. Chosen by
hand; `make sensitivity` varies it."""
BELOW_TOLERANCES = 3.0
"""Points more than this many tolerances below a plane vote against it: a factor. It guards
rooms with a table top larger than the visible floor (`test_find_floor_rejects_a_table`)."""


@dataclass(frozen=True, kw_only=True)
class FloorPlaneSettings(Settings):
    """Settings of the floor detection."""

    tilt: float = setting(
        40.0, "Largest tilt of the camera; higher also accepts slopes as floors",
        unit="degrees", minimum=1.0, maximum=80.0,
    )  # fmt: skip
    extent: float = setting(
        0.25,
        "Minimum spread of the visible floor in its narrow direction; higher rejects small"
        " patches", unit="m", minimum=0.01, maximum=10.0,
    )  # fmt: skip
    min_fraction: float = setting(
        0.03,
        "Minimum fraction of the visible points on the floor; higher rejects small patches",
        minimum=0.0, maximum=1.0, former="share",
    )  # fmt: skip
    n_trials: int = setting(
        600, "Number of planes to try; more finds floors that are barely visible",
        minimum=1, maximum=100_000, advanced=True,
    )  # fmt: skip
    seed: int = setting(
        0, "Random seed; a different seed tries different points", minimum=0, maximum=2**31 - 1
    )


@dataclass(frozen=True, eq=False)
class FloorPlane:
    """A plane in the frame of a camera.

    Attributes
    ----------
    up : float array, shape (3,)
        Unit vector against gravity.
    height : float, meters
        Of the camera above the floor.
    """

    up: Array
    height: float

    def heights(self, points: Array) -> Array:
        """Return the heights above the floor, meters, of camera-frame points (..., 3)."""
        return points @ self.up + self.height

    def world_from_camera(self) -> tuple[Array, Array]:
        """Return the rotation (3, 3) and translation (3,) from the camera to the world frame.

        Z is up and 0 on the floor. The origin is below the camera, which looks along +Y: an
        actor who faces the camera faces -Y.
        """
        forward = np.array([0.0, 0.0, 1.0])
        forward -= (forward @ self.up) * self.up
        forward /= np.linalg.norm(forward)
        rotation = np.stack([np.cross(forward, self.up), forward, self.up])
        return rotation, np.array([0.0, 0.0, self.height])


LEVEL = FloorPlane(LEVEL_UP, 0.0)
"""Default without a visible floor: a level camera at height 0."""


def find_floor(
    recording: DepthRecording,
    settings: FloorPlaneSettings = FloorPlaneSettings(),
    *,
    progress: Progress = unwatched,
) -> FloorPlane | None:
    """Find the floor of a recording: the largest upward plane with few points below it.

    RANSAC [1]_ tests planes through three random points of images spread over the recording.
    Points within the sensor noise vote for a plane. Points below it vote against it, as
    below a table. A least-squares fit to the inliers refines the best plane.

    Parameters
    ----------
    recording : DepthRecording
        With its background, or at least the floor around the feet.
    settings : FloorPlaneSettings
    progress : Progress

    Returns
    -------
    FloorPlane or None
        None without a visible floor, as in images that contain only the actor.

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
    for fraction in FIT_TOLERANCES:
        inliers = points[np.abs(points @ up + height) <= fraction * _tolerance(points)]
        if len(inliers) < 3:
            return None
        up, height, extent = _fit_plane(inliers)
    steep = float(up @ LEVEL_UP) < np.cos(np.radians(settings.tilt))
    if steep or extent < settings.extent or len(inliers) < settings.min_fraction * len(points):
        return None
    return FloorPlane(up, height)


def _points(recording: DepthRecording, rng: np.random.Generator, progress: Progress) -> Array:
    """Return points of images spread over the recording, shape (n, 3)."""
    n_images = min(MAX_IMAGES, recording.n_frames)
    frames = np.linspace(0, recording.n_frames - 1, n_images).round().astype(int)
    rays = recording.camera.rays()
    sampled = []
    for index, frame in enumerate(frames.tolist()):
        depth = recording.frame(frame)
        rows, columns = np.nonzero(depth)
        chosen = rng.permutation(len(rows))[: MAX_POINTS // n_images]
        rows, columns = rows[chosen], columns[chosen]
        sampled.append(rays[rows, columns] * depth[rows, columns, np.newaxis])
        progress((index + 1) / n_images, "Finding the floor")
    return np.concatenate(sampled)


def _best_plane(
    points: Array, settings: FloorPlaneSettings, rng: np.random.Generator
) -> tuple[Array, float] | None:
    first, second, third = points[rng.integers(len(points), size=(3, settings.n_trials))]
    normals = np.cross(second - first, third - first)
    lengths = np.linalg.norm(normals, axis=-1, keepdims=True)
    normals = np.where(normals @ LEVEL_UP < 0.0, -1.0, 1.0)[:, np.newaxis] * normals
    normals /= np.where(lengths > 0.0, lengths, np.inf)
    upright = normals @ LEVEL_UP > np.cos(np.radians(settings.tilt))
    normals, first = normals[upright], first[upright]
    if not len(normals):
        return None
    heights = -(normals * first).sum(axis=-1)
    distances = (normals @ points.T + heights[:, np.newaxis]) / _tolerance(points)
    votes = (np.abs(distances) <= 1.0).sum(axis=-1)
    votes = votes - (distances < -BELOW_TOLERANCES).sum(axis=-1)
    best = int(np.argmax(votes))
    return normals[best], float(heights[best])


def _tolerance(points: Array) -> Array:
    return np.asarray(TOLERANCE_M + TOLERANCE_PER_M2 * points[..., 2] ** 2)


def _fit_plane(points: Array) -> tuple[Array, float, float]:
    """Return normal, height and narrower extent of the least-squares plane."""
    weights = _tolerance(points) ** -2
    center = np.average(points, axis=0, weights=weights)
    variances, axes = np.linalg.eigh(np.cov(points.T, aweights=weights))
    up = axes[:, 0] if axes[:, 0] @ LEVEL_UP > 0.0 else -axes[:, 0]
    return up, float(-up @ center), float(np.sqrt(max(variances[1], 0.0)))
