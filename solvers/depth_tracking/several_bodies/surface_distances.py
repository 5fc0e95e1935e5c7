"""Distance of points to the surface of a body."""

import numpy as np

from ...arrays import Array
from ..body import CAPSULE_SEGMENTS, BodyModel, segment_frames

_MIN_RADIUS = 1e-9
"""Distance from the axis relative to the radius, below which it is not smaller. It guards a
division."""


def surface_distances(body: BodyModel, pose: Array, points: Array) -> Array:
    """Return the distance of points (n, 3) to the nearest capsule, shape (n,), meters.

    It is negative inside. The distance is along the shortest line to the axis, in coordinates
    divided by the radii: exact for round capsules, and an upper bound for elliptic ones.

    Parameters
    ----------
    body : BodyModel
    pose : shape (36,)
    points : shape (n, 3), meters
        Camera frame.
    """
    frames = segment_frames(body, pose)[CAPSULE_SEGMENTS]
    scales = 1.0 / body.radii[:, [0, 1, 1]]
    distances = np.full(len(points), np.inf)
    for frame, scale, ends in zip(frames, scales, body.capsule_ends, strict=True):
        start, stop = ends * scale
        scaled = (points - frame[:3, 3]) @ frame[:3, :3] * scale - start
        axis = stop - start
        along = np.clip(scaled @ axis / (axis @ axis), 0.0, 1.0)
        outward = scaled - along[:, np.newaxis] * axis
        radii = np.maximum(np.sqrt(np.einsum("ni,ni->n", outward, outward)), _MIN_RADIUS)
        outward /= scale
        lengths = np.sqrt(np.einsum("ni,ni->n", outward, outward))
        np.minimum(distances, lengths * (1.0 - 1.0 / radii), out=distances)
    return distances
