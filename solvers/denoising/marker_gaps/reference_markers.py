"""The points that tell where a lost one is: which move along with it, and their frame."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

MOST = 24
"""Points that take part in foretelling one."""
FEWEST = 3
"""Points that span a frame."""
COVERED, LEARNED = 0.8, 0.6
"""Shares of the gap, and of the frames in which the lost point is seen, that all companions
together have to be seen in."""
APART, OFF_LINE = 0.01, 0.03
"""Metres that the second point is from the first, and the third from their line, at least."""
SLACK = 0.001
"""Metres that even a distance which never varied is held to be uncertain by."""
N_FITS = 3


class Companions(NamedTuple):
    """Points whose distance to a lost one varies least, the first three not on a line."""

    points: NDArray[np.intp]
    slack: Array
    """Standard deviation of each one's distance to the lost point, metres."""
    learned: NDArray[np.intp]
    """Frames in which the lost point and all companions are seen."""
    foretold: NDArray[np.intp]
    """Frames of the gap in which all companions are seen."""


def find_companions(
    positions: Array, seen: Flags, there: Flags, point: int, gap: Flags
) -> Companions | None:
    """Choose the points that are nearest to being rigid with the lost one.

    Parameters
    ----------
    positions : shape (n_frames, n_points, 3), metres
    seen : shape (n_frames,)
        Where the lost point is seen.
    there : shape (n_frames, n_points)
        Where the others can be used.
    point : int
        The lost one.
    gap : shape (n_frames,)
        Where it is to be foretold.

    Returns
    -------
    Companions, or None where fewer than three points will do.
    """
    slack = _slack(positions, seen, there, point)
    coverage = there[gap].mean(axis=0)
    usable = np.isfinite(slack) & (coverage >= COVERED * coverage.max(initial=0.0))
    usable &= coverage > 0.0
    learned, foretold = seen.copy(), gap.copy()
    chosen: list[int] = []
    fewest, least = LEARNED * seen.sum(), COVERED * coverage.max(initial=0.0) * gap.sum()
    for other in np.argsort(slack, kind="stable"):
        if not usable[other] or len(chosen) == MOST:
            continue
        both, during = learned & there[:, other], foretold & there[:, other]
        if both.sum() >= fewest and during.sum() >= least:
            learned, foretold = both, during
            chosen.append(int(other))
    if len(chosen) < FEWEST:
        return None
    order = _spanning_first(positions[learned][:, chosen])
    points = np.array(chosen)[order]
    return Companions(points, slack[points], np.flatnonzero(learned), np.flatnonzero(foretold))


def _slack(positions: Array, seen: Flags, there: Flags, point: int) -> Array:
    """Return how much each distance to the point varies, metres; infinite where unknown."""
    both = seen[:, None] & there
    both[:, point] = False
    count = both.sum(axis=0)
    apart = np.linalg.norm(positions - positions[:, [point]], axis=2)
    apart = np.where(both, apart, 0.0)
    mean = apart.sum(axis=0) / np.maximum(count, 1)
    square = (np.where(both, apart - mean, 0.0) ** 2).sum(axis=0) / np.maximum(count, 1)
    return np.where(count >= LEARNED * seen.sum(), np.sqrt(square), np.inf)


def _spanning_first(places: Array) -> NDArray[np.intp]:
    """Put three to the front that are not on one line; else the order is kept.

    Parameters
    ----------
    places : shape (n_frames, n_companions, 3)
    """
    order = list(range(places.shape[1]))
    away = np.linalg.norm(places - places[:, :1], axis=2).mean(axis=0)
    second = next((place for place in order[1:] if away[place] > APART), 1)
    line = places[:, second] - places[:, 0]
    length = np.maximum(np.linalg.norm(line, axis=1), 1e-9)
    arms = places - places[:, :1]
    height = np.linalg.norm(np.cross(line[:, None], arms), axis=2) / length[:, None]
    off_line = height.mean(axis=0)
    off_line[[0, second]] = 0.0
    third = next((place for place in order[1:] if off_line[place] > OFF_LINE), None)
    third = int(np.argmax(off_line)) if third is None else third
    front = [0, second, third]
    return np.array(front + [place for place in order if place not in front])


def body_frames(places: Array, weights: Array) -> tuple[Array, Array]:
    """Fit a rigid shape to points in every frame (Kabsch 1976, doi:10.1107/S0567739476001873).

    The shape is their mean, fitted in turn with the frames.

    Parameters
    ----------
    places : shape (n_frames, n_points, 3), metres
    weights : shape (n_points,)

    Returns
    -------
    turns : shape (n_frames, 3, 3)
        From the frame of the shape to the world.
    origins : shape (n_frames, 3), metres
    """
    weights = weights / weights.sum()
    origins = np.einsum("p,fpi->fi", weights, places)
    arms = places - origins[:, None]
    shape = arms[len(arms) // 2]
    for _ in range(N_FITS):
        spread = np.einsum("p,fpi,pj->fij", weights, arms, shape)
        left, _, right = np.linalg.svd(spread)
        left[:, :, 2] *= np.linalg.det(left @ right)[:, None]
        turns = left @ right
        shape = np.einsum("fij,fpi->pj", turns, arms) / len(arms)
    return turns, origins
