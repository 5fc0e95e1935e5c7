"""Detect body parts among classified pixels, and reject misclassified ones."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...settings import Settings, setting
from ..body import BodyModel
from ..forest import N_PARTS
from .part_capsules import part_axes, part_radii

MEAN_SURFACE_DEPTH = np.pi / 4.0
"""Mean distance of a cylinder's visible surface in front of its axis, relative to the radius.
By definition: pi / 4."""
FULL_WEIGHT_FACTOR = 5.0
"""Number of inliers from which a part has full weight, as a factor of `min_part_pixels`. Chosen
by hand; `make sensitivity` varies it."""
MIN_SPAN_FRACTION = 0.2
"""Minimum distance of the two pixels that define an axis, a fraction of the part's length. Half
and twice are no better (`make sensitivity`)."""


@dataclass(frozen=True, kw_only=True)
class RobustPartsSettings(Settings):
    """Settings of the part detection."""

    n_samples: int = setting(
        60, "Pairs of pixels sampled per part; higher is more robust and slower",
        minimum=1, maximum=10_000,
    )  # fmt: skip
    n_pixels: int = setting(
        700, "Pixels used; higher is more robust and slower", minimum=50, maximum=1_000_000
    )
    looseness: float = setting(
        1.3, "Maximum distance of a pixel from the part's axis, in radii",
        minimum=1.0, maximum=5.0,
    )  # fmt: skip
    min_part_pixels: int = setting(
        4, "Minimum pixels of a part; higher rejects more false detections",
        minimum=2, maximum=1000, former="least_pixels",
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class FoundParts:
    """Detected body parts.

    Attributes
    ----------
    centers : shape (N_PARTS, 3), meters
        Axis center of the visible section of each part, camera frame; NaN: missing.
    weights : shape (N_PARTS,)
        Visible fraction of each part, 0 to 1.
    points : shape (n, 3), meters
        Inlier points on the surface.
    labels : int, shape (n,)
        Part of each point, as index in `PARTS`.
    """

    centers: Array
    weights: Array
    points: Array
    labels: NDArray[np.intp]

    def swap_parts(self, order: NDArray[np.intp]) -> "FoundParts":
        """Return the parts with labels permuted by `order`."""
        return FoundParts(
            self.centers[order], self.weights[order], self.points, order[self.labels]
        )


def find_parts(
    points: Array,
    labels: NDArray[np.intp],
    body: BodyModel,
    rng: np.random.Generator,
    settings: RobustPartsSettings = RobustPartsSettings(),
) -> FoundParts:
    """Detect each part by random sampling [1]_.

    Two pixels of a part, moved inward by its radius, define the axis of a capsule with the
    part's length and radius. The best pair maximizes the number of the part's pixels inside
    its capsule minus those of other parts. The part's pixels outside are rejected.

    Parameters
    ----------
    points : shape (n, 3), meters
        Observed points of a body, camera frame.
    labels : int, shape (n,)
        Most probable part of each point, as index in `PARTS`.
    body : BodyModel
    rng : Generator
    settings : RobustPartsSettings

    References
    ----------
    .. [1] Wei, Zhang, Chai (2012), section 4.2 and eq. 14.
    """
    if len(points) > settings.n_pixels:
        chosen = np.sort(rng.choice(len(points), settings.n_pixels, replace=False))
        points, labels = points[chosen], labels[chosen]
    rays = points / np.linalg.norm(points, axis=1, keepdims=True)
    axes, radii = part_axes(body), part_radii(body)
    centers = np.full((N_PARTS, 3), np.nan)
    weights = np.zeros(N_PARTS)
    is_inlier = np.zeros(len(points), dtype=np.bool_)
    for part in range(N_PARTS):
        part_pixels = np.flatnonzero(labels == part)
        if len(part_pixels) < settings.min_part_pixels:
            continue
        length = float(np.linalg.norm(axes[part, 1] - axes[part, 0]))
        inside = _best_capsule(points, rays, part_pixels, length, radii[part], rng, settings)
        if inside.sum() < settings.min_part_pixels:
            continue
        part_inliers = part_pixels[inside[part_pixels]]
        is_inlier[part_inliers] = True
        surface_depth = MEAN_SURFACE_DEPTH * radii[part].mean()
        centers[part] = points[part_inliers].mean(axis=0) + surface_depth * rays[
            part_inliers
        ].mean(axis=0)
        weights[part] = min(
            1.0, len(part_inliers) / (FULL_WEIGHT_FACTOR * settings.min_part_pixels)
        )
    return FoundParts(centers, weights, points[is_inlier], labels[is_inlier])


def _best_capsule(
    points: Array,
    rays: Array,
    part_pixels: NDArray[np.intp],
    length: float,
    radii: Array,
    rng: np.random.Generator,
    settings: RobustPartsSettings,
) -> NDArray[np.bool_]:
    """Return the mask of points in the best capsule of the part with pixels `part_pixels`."""
    first, second = rng.choice(part_pixels, (2, settings.n_samples))
    starts = points[first] + radii.mean() * rays[first]
    directions = points[second] + radii.mean() * rays[second] - starts
    distances = np.linalg.norm(directions, axis=1)
    max_distance = length + radii.max()
    usable = (
        (distances <= max_distance)
        & (distances >= MIN_SPAN_FRACTION * length)
        & (distances > 0.0)
    )
    if not usable.any():
        usable = np.arange(len(distances)) == distances.argmin()
    starts, directions, distances = (
        starts[usable],
        directions[usable],
        np.maximum(distances[usable], 1e-6),
    )
    midpoints, axes = starts + 0.5 * directions, directions / distances[:, np.newaxis]
    from_midpoint = points - midpoints[:, np.newaxis]
    along = np.einsum("snk,sk->sn", from_midpoint, axes)
    beyond_ends = np.maximum(np.abs(along) - 0.5 * length, 0.0)
    squared_distances = (
        np.einsum("snk,snk->sn", from_midpoint, from_midpoint) - along**2 + beyond_ends**2
    )
    inside = squared_distances <= (settings.looseness * radii.max()) ** 2
    n_inside = inside.sum(axis=1)
    n_own = inside[:, part_pixels].sum(axis=1)
    return np.asarray(inside[(2 * n_own - n_inside).argmax()])
