"""The surface term of [LOU12]: visible points follow the closest observed ones, colour too."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..body import CAPSULE_SEGMENTS, Integers, SurfaceRows, rows_toward_targets
from .hypothesis import Hypothesis
from .observation import Observation

Array = NDArray[np.float64]

WINDOW = 7
"""Pixels to each side that are searched, in a picture of 320 columns: 15 x 15."""
THINNING = 4
"""In a picture of 320 columns every so many columns and rows have a point that is matched."""
COLOR_WEIGHT = 1e-4
"""Metres that a difference of 1 in intensity (0 to 255) counts as much as."""


@dataclass(frozen=True, eq=False)
class PreviousFrame:
    """The frame before: where the body was, and which colours the camera saw.

    Attributes
    ----------
    frames : shape (17, 4, 4)
        camera_from_segment of each segment.
    observation : Observation
        With colours.
    """

    frames: Array
    observation: Observation


def surface_term(
    hypothesis: Hypothesis,
    observation: Observation,
    memory: PreviousFrame | None,
    weight: float,
) -> SurfaceRows:
    """Return the rows of the surface term of [LOU12]_, eq. 3.4 to 3.7.

    For points on a grid of pixels, the closest observed point is searched in a window of
    15 x 15 pixels (of 320 columns), where closeness is distance plus 0.0001 times the
    difference in intensity. A point's own intensity is what the camera saw there in the frame
    before; without colours, and where the point was out of sight, distance alone decides.

    Parameters
    ----------
    hypothesis : Hypothesis
    observation : Observation
    memory : PreviousFrame or None
    weight : float, per square metre

    References
    ----------
    .. [LOU12] Lou (2012). Acquiring 3D full-body motion from noisy and ambiguous input. PhD
       dissertation, Texas A&M University, section 3.4.1.
    """
    camera = observation.camera
    scale = camera.width / 320.0
    rows, columns = np.divmod(hypothesis.picture.pixels, camera.width)
    thin = max(1, round(THINNING * scale))
    chosen = np.flatnonzero((rows % thin == 0) & (columns % thin == 0))
    pixels = neighbours(rows[chosen], columns[chosen], observation, round(WINDOW * scale))
    points = hypothesis.points[chosen]
    apart = observation.points_at(pixels.ravel()).reshape(*pixels.shape, 3)
    apart -= points[:, np.newaxis]
    costs = np.sqrt(np.einsum("nki,nki->nk", apart, apart))
    if memory is not None and memory.observation.color is not None:
        costs += COLOR_WEIGHT * _color_differences(hypothesis, chosen, pixels, observation,
                                                   memory)  # fmt: skip
    costs[observation.flat[pixels] == 0.0] = np.inf
    best = costs.argmin(axis=1)
    each = np.arange(len(chosen))
    found = np.isfinite(costs[each, best])
    targets = points + apart[each, best]
    return rows_toward_targets(
        points[found], targets[found], np.full(int(found.sum()), weight),
        hypothesis.picture.capsules[chosen[found]],
    )  # fmt: skip


def neighbours(
    rows: Integers, columns: Integers, observation: Observation, reach: int
) -> Integers:
    """Return the pixels (n, k) of the square windows around these, cut off at the border."""
    camera = observation.camera
    offsets = np.arange(-reach, reach + 1)
    down = np.clip(rows[:, np.newaxis] + offsets, 0, camera.height - 1)
    across = np.clip(columns[:, np.newaxis] + offsets, 0, camera.width - 1)
    pixels = down[:, :, np.newaxis] * camera.width + across[:, np.newaxis, :]
    flat: Integers = pixels.reshape(len(rows), -1)
    return flat


def _color_differences(
    hypothesis: Hypothesis,
    chosen: Integers,
    pixels: Integers,
    observation: Observation,
    memory: PreviousFrame,
) -> Array:
    """Return how far intensities of pixels (n, k) are from those remembered; 0 if unknown."""
    remembered = remembered_intensities(hypothesis, chosen, memory)
    now = observation.intensities[pixels]
    differences: Array = np.abs(now - remembered[:, np.newaxis])
    return np.nan_to_num(differences)


def remembered_intensities(
    hypothesis: Hypothesis, chosen: Integers, memory: PreviousFrame
) -> Array:
    """Return which intensity visible points had in the frame before, NaN if out of sight."""
    segments = CAPSULE_SEGMENTS[hypothesis.picture.capsules[chosen]]
    now, then = hypothesis.frames[segments], memory.frames[segments]
    local = np.einsum("nji,nj->ni", now[:, :3, :3], hypothesis.points[chosen] - now[:, :3, 3])
    before = np.einsum("nij,nj->ni", then[:, :3, :3], local) + then[:, :3, 3]
    camera = memory.observation.camera
    columns, rows = np.nan_to_num(np.rint(camera.project(before)), nan=-1.0).astype(int).T
    inside = (columns >= 0) & (rows >= 0) & (columns < camera.width) & (rows < camera.height)
    pixels = np.where(inside, rows * camera.width + columns, 0)
    seen = inside & (memory.observation.flat[pixels] > 0.0)
    return np.where(seen, memory.observation.intensities[pixels], np.nan)
