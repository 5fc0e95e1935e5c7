"""Find the parts of a body among classified pixels, and leave out misclassified ones."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...settings import Settings, setting
from ..body import BodyModel
from ..forest import N_PARTS
from .part_capsules import part_axes, part_radii

Array = NDArray[np.float64]
MEAN_DEPTH = np.pi / 4.0
"""Of the radius: how far the visible side of a cylinder is before its axis, on average."""


@dataclass(frozen=True, kw_only=True)
class RobustPartsSettings(Settings):
    """How parts are looked for."""

    n_samples: int = setting(
        60, "Pairs of pixels tried for each part; more is surer and slower",
        minimum=1, maximum=10_000,
    )  # fmt: skip
    n_pixels: int = setting(
        700, "Pixels looked at; more is surer and slower", minimum=50, maximum=1_000_000
    )
    looseness: float = setting(
        1.3, "How far from the axis, in radii, a pixel still belongs to the part",
        minimum=1.0, maximum=5.0,
    )  # fmt: skip
    least_pixels: int = setting(
        4, "Parts of fewer pixels are not seen; more is surer of those that are",
        minimum=2, maximum=1000,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class FoundParts:
    """Where parts are.

    Attributes
    ----------
    centres : shape (N_PARTS, 3), metres
        Middle of the axis of what is seen of each part, camera frame; NaN: not seen.
    weights : shape (N_PARTS,)
        0 to 1: how much of a part is seen; 0: nothing.
    points : shape (n, 3), metres
        Pixels that are left, on the surface.
    labels : int, shape (n,)
        The part of each of them, as its place in `PARTS`.
    """

    centres: Array
    weights: Array
    points: Array
    labels: NDArray[np.intp]

    def exchanged(self, order: NDArray[np.intp]) -> "FoundParts":
        """Return the same with each part taken for the part at its place in `order`."""
        return FoundParts(
            self.centres[order], self.weights[order], self.points, order[self.labels]
        )


def find_parts(
    points: Array,
    labels: NDArray[np.intp],
    body: BodyModel,
    rng: np.random.Generator,
    settings: RobustPartsSettings = RobustPartsSettings(),
) -> FoundParts:
    """Find each part by random sampling [1]_.

    Two pixels of a part, moved inside by its radius, span the axis of a capsule as long and
    thick as the body has it. Of many such pairs that one is taken whose capsule holds most
    pixels of the part less those of others, and the part's pixels outside of it are left out.

    Parameters
    ----------
    points : shape (n, 3), metres
        What the pixels of a body see, camera frame.
    labels : int, shape (n,)
        Place of each one's likeliest part in `PARTS`.
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
    centres = np.full((N_PARTS, 3), np.nan)
    weights = np.zeros(N_PARTS)
    kept = np.zeros(len(points), dtype=np.bool_)
    for part in range(N_PARTS):
        own = np.flatnonzero(labels == part)
        if len(own) < settings.least_pixels:
            continue
        length = float(np.linalg.norm(axes[part, 1] - axes[part, 0]))
        inside = _best_capsule(points, rays, own, length, radii[part], rng, settings)
        if inside.sum() < settings.least_pixels:
            continue
        mine = own[inside[own]]
        kept[mine] = True
        thick = MEAN_DEPTH * radii[part].mean()
        centres[part] = points[mine].mean(axis=0) + thick * rays[mine].mean(axis=0)
        weights[part] = min(1.0, len(mine) / (5.0 * settings.least_pixels))
    return FoundParts(centres, weights, points[kept], labels[kept])


def _best_capsule(
    points: Array,
    rays: Array,
    own: NDArray[np.intp],
    length: float,
    radii: Array,
    rng: np.random.Generator,
    settings: RobustPartsSettings,
) -> NDArray[np.bool_]:
    """Tell which of all points lie in the best capsule of a part that has the points `own`."""
    first, second = rng.choice(own, (2, settings.n_samples))
    starts = points[first] + radii.mean() * rays[first]
    ways = points[second] + radii.mean() * rays[second] - starts
    apart = np.linalg.norm(ways, axis=1)
    whole = length + radii.max()
    usable = (apart <= whole) & (apart >= 0.2 * length) & (apart > 0.0)
    if not usable.any():
        usable = np.arange(len(apart)) == apart.argmin()
    starts, ways, apart = starts[usable], ways[usable], np.maximum(apart[usable], 1e-6)
    middles, axes = starts + 0.5 * ways, ways / apart[:, np.newaxis]
    from_middle = points - middles[:, np.newaxis]
    along = np.einsum("snk,sk->sn", from_middle, axes)
    beyond = np.maximum(np.abs(along) - 0.5 * length, 0.0)
    square = np.einsum("snk,snk->sn", from_middle, from_middle) - along**2 + beyond**2
    inside = square <= (settings.looseness * radii.max()) ** 2
    n_inside = inside.sum(axis=1)
    n_own = inside[:, own].sum(axis=1)
    return np.asarray(inside[(2 * n_own - n_inside).argmax()])
