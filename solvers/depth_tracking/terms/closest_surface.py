"""Every observed point pulls the closest part of the body's surface that faces the camera."""

import numpy as np
from numpy.typing import NDArray

from ..body import CAPSULE_SEGMENTS, SurfaceRows
from .hypothesis import Hypothesis

Array = NDArray[np.float64]
Integers = NDArray[np.intp]

_FAR, _NOTHING = 1e3, 1e-12


def closest_surface_term(
    hypothesis: Hypothesis, points: Array, weight: float, scale: float
) -> SurfaceRows:
    """Return the rows with which observed points pull the surface along its normal.

    The closest point of a capsule is known in closed form, so that no points of the body need
    be searched. A surface that faces away from the camera cannot have been seen and does not
    attract. Distances are to first order in elliptic capsules. Far points count less
    [GM87]_: the weight falls by (1 + (distance / scale)^2)^2.

    Parameters
    ----------
    hypothesis : Hypothesis
    points : shape (n, 3), metres
        Observed, camera frame.
    weight : float, per square metre
    scale : float, metres

    References
    ----------
    .. [GM87] Geman, McClure (1987). Statistical methods for tomographic image reconstruction.
       Bulletin of the International Statistical Institute 52(4).
    """
    distances, directions, capsules = closest_surface(hypothesis, points)
    known = np.abs(distances) < _FAR
    distances, directions, capsules = distances[known], directions[known], capsules[known]
    weights = weight / (1.0 + (distances / scale) ** 2) ** 2
    return SurfaceRows(points[known], directions, distances, weights, capsules)


def closest_surface(hypothesis: Hypothesis, points: Array) -> tuple[Array, Array, Integers]:
    """Return the closest surface that faces the camera.

    Returns
    -------
    (n,) array
        How far outside it each point is, metres; beyond all measure where none faces it.
    (n, 3) array
        Unit normals of the surface.
    (n,) array of int
        The capsules.
    """
    body, frames = hypothesis.body, hypothesis.frames[CAPSULE_SEGMENTS]
    scales = 1.0 / body.radii[:, [0, 1, 1]]
    starts, stops = body.capsule_ends.swapaxes(0, 1) * scales
    axes = stops - starts
    # One array (n_points, n_capsules) per component: all steps run over whole arrays.
    rays, out = [], []
    along = 0.0
    lengths = (axes**2).sum(axis=1)
    for i in range(3):
        column = frames[:, :3, i]
        ray = points @ column.T
        origin = np.einsum("ni,ni->n", column, frames[:, :3, 3])
        part = ray * scales[:, i] - (origin * scales[:, i] + starts[:, i])
        along = along + part * (axes[:, i] / lengths)
        rays.append(ray)
        out.append(part)
    along = np.clip(along, 0.0, 1.0)
    out = [part - along * axes[:, i] for i, part in enumerate(out)]
    size = np.sqrt(out[0] ** 2 + out[1] ** 2 + out[2] ** 2) + _NOTHING
    out = [part * scales[:, i] for i, part in enumerate(out)]
    slope = np.sqrt(out[0] ** 2 + out[1] ** 2 + out[2] ** 2) + _NOTHING
    distances = (size - 1.0) * size / slope
    facing = out[0] * rays[0] + out[1] * rays[1] + out[2] * rays[2]
    distances[facing >= 0.0] = _FAR
    capsules = np.abs(distances).argmin(axis=1)
    each = np.arange(len(points))
    normals = np.stack([part[each, capsules] for part in out], axis=1)
    normals /= slope[each, capsules, np.newaxis]
    outward = np.einsum("pij,pj->pi", frames[capsules, :3, :3], normals)
    return distances[each, capsules], outward, capsules
