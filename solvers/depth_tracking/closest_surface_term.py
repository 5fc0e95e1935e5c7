"""Every observed point pulls the closest part of the body's surface that faces the camera."""

import numpy as np
from numpy.typing import NDArray

from .body_tables import CAPSULE_SEGMENTS
from .hypothesis import Hypothesis
from .normal_equations import SegmentEquations, SurfaceRows, segment_equations

Array = NDArray[np.float64]
Integers = NDArray[np.intp]

_FAR = 1e3


def closest_surface_term(
    hypothesis: Hypothesis, points: Array, weight: float, scale: float
) -> SegmentEquations:
    """Return what observed points ask of the surface, measured along its normal.

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
    return segment_equations(closest_surface_rows(hypothesis, points, weight, scale))


def closest_surface_rows(
    hypothesis: Hypothesis, points: Array, weight: float, scale: float
) -> SurfaceRows:
    """Return a row per point of `closest_surface_term`."""
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
    rotations = frames[:, :3, :3]
    flat = rotations.transpose(1, 0, 2).reshape(3, -1)
    rays = (points @ flat).reshape(len(points), -1, 3)
    scales = 1.0 / body.radii[:, [0, 1, 1]]
    starts, stops = body.capsule_ends.swapaxes(0, 1) * scales
    origins = np.einsum("nji,nj->ni", rotations, frames[:, :3, 3])
    axes = stops - starts
    from_start = rays * scales
    from_start -= origins * scales + starts
    along = np.einsum("pni,ni->pn", from_start, axes / (axes**2).sum(axis=1)[:, np.newaxis])
    np.clip(along, 0.0, 1.0, out=along)
    from_start -= along[..., np.newaxis] * axes
    size = np.sqrt(np.einsum("pni,pni->pn", from_start, from_start)) + 1e-12
    from_start *= scales
    slope = np.sqrt(np.einsum("pni,pni->pn", from_start, from_start)) + 1e-12
    distances = (size - 1.0) * size / slope
    distances[np.einsum("pni,pni->pn", from_start, rays) >= 0.0] = _FAR
    capsules = np.abs(distances).argmin(axis=1)
    each = np.arange(len(points))
    normals = from_start[each, capsules] / slope[each, capsules, np.newaxis]
    return (
        distances[each, capsules],
        np.einsum("pij,pj->pi", rotations[capsules], normals),
        capsules,
    )
