"""Fit cylinders to the classified pixels of body parts by random sampling."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array, Flags
from ...depth_scene import Camera
from ...settings import Settings, setting

POSITION_STD_M, RADIUS_STD, SHRINK_FACTOR = 0.12, 0.15, 0.65
"""Standard deviations of the first perturbations (position; relative radius), and the factor by
which each round shrinks them. Chosen by hand; `make sensitivity` varies them."""
MOVED_FRACTION = 0.6
"""Fraction of the ends that a perturbation moves. Half and twice gain less than 1 %
(`make sensitivity`)."""
MARGIN_FRACTION = 0.2
"""Width of the border around a part, a fraction of its size in the image, whose pixels must not
be hit. Chosen by hand; `make sensitivity` varies it."""
INLIER_FACTOR = 3.0
"""Distance from the plane of a part's surface, as a factor of the median distance, up to which
a point counts. Chosen by hand; `make sensitivity` varies it."""
MIN_INLIER_M = 1e-3
"""Meters up to which a point always counts. It guards points in one plane, whose median
distance is 0."""


@dataclass(frozen=True, kw_only=True)
class CylinderSettings(Settings):
    """Settings of the cylinder fit."""

    n_samples: int = setting(
        300, "Initial samples per part; higher is more robust and slower",
        minimum=1, maximum=100_000,
    )  # fmt: skip
    rounds: int = setting(
        7, "Refinement rounds around the best cylinder; higher is finer and slower",
        minimum=0, maximum=100,
    )  # fmt: skip
    max_pixels: int = setting(
        1500, "Pixels that a cylinder is held to; more is finer and slower",
        minimum=50, maximum=1_000_000, former="most_pixels",
    )  # fmt: skip
    seed: int = setting(0, "Seed of the random samples", minimum=0)


@dataclass(frozen=True, eq=False)
class Cylinder:
    """A cylinder in the camera frame.

    Attributes
    ----------
    ends : shape (2, 3), meters
        Ends of the axis.
    radius : float, meters
    quality : float
        Pixels of the part inside minus other pixels inside, divided by the pixels of the part.
    """

    ends: Array
    radius: float
    quality: float

    @property
    def length(self) -> float:
        """Length of the axis, meters."""
        return float(np.linalg.norm(self.ends[1] - self.ends[0]))


def sample_cylinder(
    depth: Array,
    part_mask: Flags,
    camera: Camera,
    radii: tuple[float, float],
    rng: np.random.Generator,
    settings: CylinderSettings = CylinderSettings(),
) -> Cylinder | None:
    """Return the cylinder that maximizes Q = inliers - outliers, or None [1]_.

    A radius and two pixels of the part define a cylinder, one radius behind the plane of the
    part's surface. Inliers are the part's pixels inside its projection; outliers are all
    other pixels there. After the initial samples, each round tests smaller perturbations of
    the best cylinder. None means that the part has fewer than four pixels.

    Parameters
    ----------
    depth : shape (height, width), meters
        0: no reading.
    part_mask : bool, shape (height, width)
        Pixels classified as the part.
    camera : Camera
    radii : tuple of float, meters
        Minimum and maximum radius.
    rng : Generator
    settings : CylinderSettings

    References
    ----------
    .. [1] Wei, Zhang, Chai (2012), section 6, eq. 14.
    """
    points = camera.back_project(depth)[part_mask & (depth > 0.0)]
    if len(points) < 4:
        return None
    rays, is_part = _rays_around(part_mask, camera, settings.max_pixels)
    directions = points / points[:, 2:]
    surface = _surface_plane(points)
    ends = directions[rng.integers(len(points), size=(settings.n_samples, 2))]
    best, cylinder = _best_cylinder(
        ends, rng.uniform(*radii, settings.n_samples), surface, rays, is_part
    )
    depth_m = float(np.median(points[:, 2]))
    for round_index in range(settings.rounds):
        spread = SHRINK_FACTOR**round_index
        n = settings.n_samples // 2
        radius = cylinder.radius * np.exp(RADIUS_STD * spread * rng.standard_normal(n))
        is_moved = rng.random((n, 2, 1)) < MOVED_FRACTION
        offsets = is_moved * (
            POSITION_STD_M / depth_m * spread * rng.standard_normal((n, 2, 3))
        )
        offsets[..., 2] = 0.0
        shifted, other = _best_cylinder(
            best + offsets, np.clip(radius, *radii), surface, rays, is_part
        )
        if other.quality > cylinder.quality:
            best, cylinder = shifted, other
    return cylinder


def _surface_plane(points: Array) -> Array:
    """Return the plane of a part's surface: depth = (1, x / z, y / z) . plane."""
    rows = np.column_stack([np.ones(len(points)), points[:, :2] / points[:, 2:]])
    inliers = np.ones(len(points), dtype=np.bool_)
    for _ in range(3):
        plane = np.linalg.lstsq(rows[inliers], points[inliers, 2], rcond=None)[0]
        residuals = np.abs(rows @ plane - points[:, 2])
        inliers = residuals <= max(INLIER_FACTOR * float(np.median(residuals)), MIN_INLIER_M)
    return np.asarray(plane)


def _rays_around(part_mask: Flags, camera: Camera, max_pixels: int) -> tuple[Array, Flags]:
    """Return the rays (n, 3) in and around a part, and the mask of rays that hit it."""
    rows, columns = np.nonzero(part_mask)
    margin = 2 + int(MARGIN_FRACTION * max(np.ptp(rows), np.ptp(columns)))
    window = (
        slice(max(rows.min() - margin, 0), rows.max() + margin + 1),
        slice(max(columns.min() - margin, 0), columns.max() + margin + 1),
    )
    is_part = part_mask[window]
    step = int(np.ceil(np.sqrt(is_part.size / max_pixels)))
    rays = camera.rays()[window][::step, ::step].reshape(-1, 3)
    return _unit(rays), is_part[::step, ::step].reshape(-1)


def _best_cylinder(
    directions: Array, radii: Array, surface: Array, rays: Array, is_part: Flags
) -> tuple[Array, Cylinder]:
    """Return the best cylinder with ends along directions (n, 2, 3) and radii (n,).

    Their axes lie a radius behind the surface of the part.
    """
    depths = surface[0] + directions[..., :2] @ surface[1:] + radii[:, np.newaxis]
    ends = directions * depths[..., np.newaxis]
    # Seen along a ray, a cylinder's axis is a line from a to b in the plane across the ray.
    along = np.einsum("nek,mk->nem", ends, rays)
    across = ends[:, :, np.newaxis] - along[..., np.newaxis] * rays
    a, direction = across[:, 0], across[:, 1] - across[:, 0]
    square = np.einsum("nmk,nmk->nm", direction, direction) + 1e-12
    position = -np.einsum("nmk,nmk->nm", a, direction) / square
    distance_squared = np.einsum("nmk,nmk->nm", a, a) - position**2 * square
    inside = (
        (distance_squared <= radii[:, np.newaxis] ** 2) & (position >= 0.0) & (position <= 1.0)
    )
    quality = inside[:, is_part].sum(axis=1) - inside[:, ~is_part].sum(axis=1)
    best = int(quality.argmax())
    quality_fraction = float(quality[best] / max(is_part.sum(), 1))
    return directions[best], Cylinder(ends[best], float(radii[best]), quality_fraction)


def _unit(vectors: Array) -> Array:
    unit: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return unit
