"""Fit cylinders to the classified pixels of a body's parts by random sampling."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import Camera
from ...settings import Settings, setting

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

FARTHER, THICKER, CALMER = 0.12, 0.15, 0.65
"""Standard deviations, metres and as a share, of the first changes to the best cylinder, and
how much smaller they become by each round."""


@dataclass(frozen=True, kw_only=True)
class CylinderSettings(Settings):
    """How hard cylinders are looked for."""

    n_samples: int = setting(
        300, "Cylinders tried for each part at first; more is surer and slower",
        minimum=1, maximum=100_000,
    )  # fmt: skip
    rounds: int = setting(
        7, "Times that cylinders near the best one are tried; more is finer and slower",
        minimum=0, maximum=100,
    )  # fmt: skip
    most_pixels: int = setting(
        1500, "Pixels that a cylinder is held to; more is finer and slower",
        minimum=50, maximum=1_000_000,
    )  # fmt: skip
    seed: int = setting(0, "Another seed draws other samples", minimum=0)


@dataclass(frozen=True, eq=False)
class Cylinder:
    """A cylinder in the camera's frame.

    Attributes
    ----------
    ends : shape (2, 3), metres
        Of its axis.
    radius : float, metres
    quality : float
        Pixels of the part inside, less others inside, as a share of the part's pixels.
    """

    ends: Array
    radius: float
    quality: float

    @property
    def length(self) -> float:
        """Metres."""
        return float(np.linalg.norm(self.ends[1] - self.ends[0]))


def sample_cylinder(
    depth: Array,
    own: Flags,
    camera: Camera,
    radii: tuple[float, float],
    rng: np.random.Generator,
    settings: CylinderSettings = CylinderSettings(),
) -> Cylinder | None:
    """Return the cylinder of greatest Q = inliers - outliers, or None of too few pixels [1]_.

    A radius and two pixels of the part make a cylinder, a radius behind the plane that the
    part's pixels see. Inliers are the part's pixels within its picture; outliers are all other
    pixels there, those of other parts and of nothing. After the first draw, ever smaller
    changes to the best cylinder are tried.

    Parameters
    ----------
    depth : shape (height, width), metres
        0: nothing.
    own : bool, shape (height, width)
        Pixels told to be of the part.
    camera : Camera
    radii : tuple of float, metres
        Smallest and largest radius to try.
    rng : Generator
    settings : CylinderSettings

    References
    ----------
    .. [1] Wei, Zhang, Chai (2012), section 6, eq. 14.
    """
    points = camera.back_project(depth)[own & (depth > 0.0)]
    if len(points) < 4:
        return None
    rays, mine = _looked_at(own, camera, settings.most_pixels)
    ways = points / points[:, 2:]
    surface = _surface(points)
    ends = ways[rng.integers(len(points), size=(settings.n_samples, 2))]
    best, cylinder = _best(ends, rng.uniform(*radii, settings.n_samples), surface, rays, mine)
    near = float(np.median(points[:, 2]))
    for round_ in range(settings.rounds):
        spread = CALMER**round_
        n = settings.n_samples // 2
        radius = cylinder.radius * np.exp(THICKER * spread * rng.standard_normal(n))
        which = rng.random((n, 2, 1)) < 0.6
        aside = which * (FARTHER / near * spread * rng.standard_normal((n, 2, 3)))
        aside[..., 2] = 0.0
        moved, other = _best(best + aside, np.clip(radius, *radii), surface, rays, mine)
        if other.quality > cylinder.quality:
            best, cylinder = moved, other
    return cylinder


def _surface(points: Array) -> Array:
    """Return the plane that pixels of a part see: depth = (1, x / z, y / z) . plane."""
    rows = np.column_stack([np.ones(len(points)), points[:, :2] / points[:, 2:]])
    kept = np.ones(len(points), dtype=np.bool_)
    for _ in range(3):
        plane = np.linalg.lstsq(rows[kept], points[kept, 2], rcond=None)[0]
        apart = np.abs(rows @ plane - points[:, 2])
        kept = apart <= max(3.0 * float(np.median(apart)), 1e-3)
    return np.asarray(plane)


def _looked_at(own: Flags, camera: Camera, most: int) -> tuple[Array, Flags]:
    """Return where pixels in and around a part look, (n, 3), and which of them see it."""
    rows, columns = np.nonzero(own)
    margin = 2 + int(0.2 * max(np.ptp(rows), np.ptp(columns)))
    around = (
        slice(max(rows.min() - margin, 0), rows.max() + margin + 1),
        slice(max(columns.min() - margin, 0), columns.max() + margin + 1),
    )
    mine = own[around]
    step = int(np.ceil(np.sqrt(mine.size / most)))
    rays = camera.rays()[around][::step, ::step].reshape(-1, 3)
    return _unit(rays), mine[::step, ::step].reshape(-1)


def _best(
    ways: Array, radii: Array, surface: Array, rays: Array, mine: Flags
) -> tuple[Array, Cylinder]:
    """Return the best of cylinders whose ends look that way (n, 2, 3), with radii (n,).

    Their axes lie a radius behind the surface of the part.
    """
    depths = surface[0] + ways[..., :2] @ surface[1:] + radii[:, np.newaxis]
    ends = ways * depths[..., np.newaxis]
    # Seen along a ray, a cylinder's axis is a line from a to b in the plane across the ray.
    along = np.einsum("nek,mk->nem", ends, rays)
    across = ends[:, :, np.newaxis] - along[..., np.newaxis] * rays
    a, way = across[:, 0], across[:, 1] - across[:, 0]
    square = np.einsum("nmk,nmk->nm", way, way) + 1e-12
    place = -np.einsum("nmk,nmk->nm", a, way) / square
    far = np.einsum("nmk,nmk->nm", a, a) - place**2 * square
    inside = (far <= radii[:, np.newaxis] ** 2) & (place >= 0.0) & (place <= 1.0)
    quality = inside[:, mine].sum(axis=1) - inside[:, ~mine].sum(axis=1)
    best = int(quality.argmax())
    share = float(quality[best] / max(mine.sum(), 1))
    return ways[best], Cylinder(ends[best], float(radii[best]), share)


def _unit(vectors: Array) -> Array:
    unit: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return unit
