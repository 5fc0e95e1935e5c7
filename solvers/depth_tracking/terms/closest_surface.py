"""The closest surface term: observed points pull the closest visible body surface."""

import numpy as np

from ...arrays import Array, Integers
from ..body import CAPSULE_SEGMENTS, SurfaceRows
from .hypothesis import Hypothesis

_NO_SURFACE, _EPSILON = 1e3, 1e-12
"""Meters: distance of a surface that faces away, and length below which there is no direction.
It guards a division."""


def closest_surface_term(
    hypothesis: Hypothesis, points: Array, weight: float, scale: float
) -> SurfaceRows:
    """Return rows that pull the surface along its normal to observed points.

    The closest point of a capsule has a closed form, so no search over surface points is
    needed. Surfaces that face away from the camera are invisible and excluded. Distances to
    elliptic capsules are first-order approximations. Distant points have lower weight
    [GM87]_: it falls by (1 + (distance / scale)^2)^2.

    Parameters
    ----------
    hypothesis : Hypothesis
    points : shape (n, 3), meters
        Observed points, camera frame.
    weight : float, per square meter
    scale : float, meters

    References
    ----------
    .. [GM87] Geman, McClure (1987). Statistical methods for tomographic image reconstruction.
       Bulletin of the International Statistical Institute 52(4).
    """
    distances, directions, capsules = closest_surface(hypothesis, points)
    valid = np.abs(distances) < _NO_SURFACE
    distances, directions, capsules = distances[valid], directions[valid], capsules[valid]
    weights = weight / (1.0 + (distances / scale) ** 2) ** 2
    return SurfaceRows(points[valid], directions, distances, weights, capsules)


def closest_surface(hypothesis: Hypothesis, points: Array) -> tuple[Array, Array, Integers]:
    """Return the closest surface that faces the camera.

    Returns
    -------
    (n,) array
        Signed distance of each point, positive outside, meters; huge without a visible surface.
    (n, 3) array
        Unit normals of the surface.
    (n,) array of int
        The capsules.
    """
    body, frames = hypothesis.body, hypothesis.frames[CAPSULE_SEGMENTS]
    scales = 1.0 / body.radii[:, [0, 1, 1]]
    starts, stops = body.capsule_ends.swapaxes(0, 1) * scales
    axes = stops - starts
    # One array (n_points, n_capsules) per component: all steps use complete arrays.
    rays, outward_components = [], []
    along = 0.0
    lengths = (axes**2).sum(axis=1)
    for i in range(3):
        column = frames[:, :3, i]
        ray = points @ column.T
        origin = np.einsum("ni,ni->n", column, frames[:, :3, 3])
        component = ray * scales[:, i] - (origin * scales[:, i] + starts[:, i])
        along = along + component * (axes[:, i] / lengths)
        rays.append(ray)
        outward_components.append(component)
    along = np.clip(along, 0.0, 1.0)
    outward_components = [
        component - along * axes[:, i] for i, component in enumerate(outward_components)
    ]
    size = (
        np.sqrt(
            outward_components[0] ** 2 + outward_components[1] ** 2 + outward_components[2] ** 2
        )
        + _EPSILON
    )
    outward_components = [
        component * scales[:, i] for i, component in enumerate(outward_components)
    ]
    slope = (
        np.sqrt(
            outward_components[0] ** 2 + outward_components[1] ** 2 + outward_components[2] ** 2
        )
        + _EPSILON
    )
    distances = (size - 1.0) * size / slope
    facing = (
        outward_components[0] * rays[0]
        + outward_components[1] * rays[1]
        + outward_components[2] * rays[2]
    )
    distances[facing >= 0.0] = _NO_SURFACE
    capsules = np.abs(distances).argmin(axis=1)
    each = np.arange(len(points))
    normals = np.stack([component[each, capsules] for component in outward_components], axis=1)
    normals /= slope[each, capsules, np.newaxis]
    outward_normals = np.einsum("pij,pj->pi", frames[capsules, :3, :3], normals)
    return distances[each, capsules], outward_normals, capsules
