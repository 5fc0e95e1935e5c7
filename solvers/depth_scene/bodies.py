"""Bodies in a depth image: pixels connected in space, not only in the image plane."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Flags
from .camera import Camera

Depth = NDArray[np.floating[Any]]

MAX_STEP_M = 0.05
"""Maximum depth step between pixels of one surface, meters. Chosen by hand; `make sensitivity`
varies it."""
MAX_STEP_PER_M2 = 0.005
"""Growth of that step with squared depth: three standard deviations of the noise of a Kinect,
0.04 m at 5 m (Khoshelham and Elberink 2012, doi:10.3390/s120201437)."""
MAX_COMPONENT_DISTANCE_M = 0.5
"""A small component, such as a hand held forward, belongs to a body within this distance. It
guards bodies that an arm or a hole in the depth divides
(`test_find_actor_keeps_a_recording_of_the_actor_alone`)."""
MAX_LIMB_FRACTION, MAX_LIMB_GAP_M = 0.4, 0.3
"""A component counts as a limb of a body, such as an occluded leg, up to this fraction of its
area and this gap. They guard bodies that furniture in front of them divides
(`test_two_people_next_to_each_other_are_two_bodies`,
`test_find_actor_works_in_a_room_with_default_settings`)."""
MIN_COMPONENT_M2 = 1e-3
"""Smaller components count as noise. Chosen by hand; `make sensitivity` varies it."""
MAX_FULL_PIXELS = 20_000
"""Number of pixels above which the image is subsampled. It bounds the run time."""
COARSE_WIDTH = 200
"""Width of the subsampled image, pixels. It bounds the run time; `make sensitivity` varies
it."""
POINT_STEP = 12
"""Every n-th point represents a body in distance tests. It bounds the run time."""


@dataclass(frozen=True, eq=False)
class LabeledBodies:
    """The bodies in a depth image.

    Attributes
    ----------
    depth : float array, shape (height, width), meters
        The depth image.
    step : int
        Step of the sampled columns and rows.
    labels : int array, shape (-(-height // step), -(-width // step))
        0: none; 1: the body with the largest surface; 2: the next, and so on.
    areas : float array, shape (n,), square meters
        Visible surface of each body, as if it faced the camera.
    centers : float array, shape (n, 3), meters
        Median point of each body, camera frame.
    """

    depth: Depth
    step: int
    labels: NDArray[np.intp]
    areas: NDArray[np.float64]
    centers: NDArray[np.float64]

    def mask(self, label: int) -> Flags:
        """Return the pixel mask (height, width) of a body."""
        own = self.labels == label
        mask = np.zeros(self.depth.shape, dtype=bool)
        if self.step == 1 or not own.any():
            return own if self.step == 1 else mask
        rows, columns = (_padded_range(own.any(axis=axis)) for axis in (1, 0))
        coarse = self.depth[:: self.step, :: self.step]
        block = tuple(
            slice(range_.start * self.step, range_.stop * self.step)
            for range_ in (rows, columns)
        )
        coarse_body = np.where(own, coarse, 0.0)[rows, columns]
        mask[block] = _refine_mask(self.depth[block], coarse_body, self.step)
        return mask


def find_bodies(
    depth: Depth, camera: Camera, min_area: float, step: int | None = None
) -> LabeledBodies:
    """Segment a depth image into bodies of at least `min_area` square meters of surface.

    Neighboring pixels are connected if their depths differ by no more than the sensor noise.
    Smaller components join the nearest body within reach, or none. Large images are subsampled,
    and the remaining pixels follow their neighbors; `step` is that of the sampled columns and
    rows, 1 for all, or None to choose it by the number of pixels with depth.
    """
    if step is None:
        is_small = int((depth > 0.0).sum()) <= MAX_FULL_PIXELS
        step = 1 if is_small else -(-camera.width // COARSE_WIDTH)
    coarse, camera = depth[::step, ::step], camera.every(step)
    components, areas = label_components(coarse, camera)
    points = _group_points(components, camera.back_project(coarse))
    large = np.flatnonzero(areas >= min_area)
    large = large[np.argsort(-areas[large], kind="stable")]
    body_of_component = np.zeros(len(areas) + 1, dtype=np.intp)
    for component in large + 1:
        body_of_component[component] = (
            _limb_owner(component, body_of_component, areas, points)
            or body_of_component.max() + 1
        )
    _join_small_components(body_of_component, areas, points)
    n_bodies = int(body_of_component.max())
    surfaces = np.zeros(n_bodies + 1)
    np.add.at(surfaces, body_of_component[1:], areas)
    centers = [np.median(each, axis=0) for each in _bodies(body_of_component, points)]
    return LabeledBodies(
        depth,
        step,
        body_of_component[components],
        surfaces[1:],
        np.array(centers).reshape(-1, 3),
    )


def _group_points(components: NDArray[np.intp], points: Array) -> list[Array]:
    """Return the points of each component, shape (n, 3); the first is unlabeled."""
    order = np.argsort(components, axis=None, kind="stable")
    ends = np.cumsum(np.bincount(components.ravel()))[:-1]
    return np.split(points.reshape(-1, 3)[order], ends)


def _bodies(body_of_component: NDArray[np.intp], points: list[Array]) -> list[Array]:
    """Return the points of each body."""
    return [
        np.concatenate([
            points[component] for component in np.flatnonzero(body_of_component == body)
        ])
        for body in range(1, int(body_of_component.max(initial=0)) + 1)
    ]


def _padded_range(occupied: Flags) -> slice:
    """Return the range of occupied indices, padded by one on both sides."""
    indices = np.flatnonzero(occupied)
    return slice(max(int(indices[0]) - 1, 0), min(int(indices[-1]) + 2, len(occupied)))


def _refine_mask(depth: Depth, coarse_depth: Depth, step: int) -> Flags:
    """Return the full-resolution pixels at the depth of the coarse body around them."""
    height, width = depth.shape
    mask = np.zeros(depth.shape, dtype=bool)
    around = np.pad(coarse_depth, 1)
    rows, columns = coarse_depth.shape
    for down in range(3):
        for right in range(3):
            shifted = around[down : down + rows, right : right + columns]
            near = shifted.repeat(step, axis=0).repeat(step, axis=1)[:height, :width]
            mask |= (near > 0.0) & (
                np.abs(depth - near) <= MAX_STEP_M + MAX_STEP_PER_M2 * near**2
            )
    return mask & (depth > 0.0)


def label_components(
    depth: Depth, camera: Camera
) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """Label connected pixels of an image, (height, width), from 1; 0 has no reading.

    Also return the surface of each component, (n_components,), in square meters.
    """
    from scipy.sparse import coo_array  # slow to import: only when needed
    from scipy.sparse.csgraph import connected_components  # slow to import: only when needed

    visible = depth > 0.0
    numbers = np.full(depth.shape, -1)
    numbers[visible] = np.arange(visible.sum())
    links = [_links(numbers, depth, axis) for axis in (0, 1)]
    first, second = np.concatenate(links, axis=1)
    n = int(visible.sum())
    graph = coo_array((np.ones(len(first), dtype=bool), (first, second)), shape=(n, n))
    n_components, labels = connected_components(graph, directed=False)
    components = np.zeros(depth.shape, dtype=np.intp)
    components[visible] = labels + 1
    surfaces = _surface(depth, camera)[visible]
    areas = np.bincount(labels, weights=surfaces, minlength=n_components)
    return components, areas.astype(np.float64)


def _links(numbers: NDArray[Any], depth: Depth, axis: int) -> NDArray[Any]:
    """Return the index pairs of connected neighbors, shape (2, n)."""
    length = depth.shape[axis]
    first, second = (
        np.take(depth, range(start, start + length - 1), axis=axis) for start in (0, 1)
    )
    nearer_depth = np.minimum(first, second)
    linked = (nearer_depth > 0.0) & (
        np.abs(first - second) <= MAX_STEP_M + MAX_STEP_PER_M2 * nearer_depth**2
    )
    ends = (np.take(numbers, range(start, start + length - 1), axis=axis) for start in (0, 1))
    return np.stack([end[linked] for end in ends])


def _surface(depth: Depth, camera: Camera) -> NDArray[np.float64]:
    """Return the surface of each pixel, square meters, as if it faced the camera."""
    return np.asarray(depth, dtype=np.float64) ** 2 / (camera.fx * camera.fy)


def _limb_owner(
    component: int,
    body_of_component: NDArray[np.intp],
    areas: NDArray[np.float64],
    points: list[Array],
) -> int:
    """Return the existing body that a large component is a limb of, 0 for none."""
    for other in np.flatnonzero(body_of_component):
        is_smaller = areas[component - 1] <= MAX_LIMB_FRACTION * areas[other - 1]
        if is_smaller and _excess_gap(points[component], points[other][::POINT_STEP]) <= 0.0:
            return int(body_of_component[other])
    return 0


def _join_small_components(
    body_of_component: NDArray[np.intp], areas: NDArray[np.float64], points: list[Array]
) -> None:
    """Assign small components to the body next to them or within reach of their center.

    `body_of_component` holds the body of each component, 0 for none. It is modified.
    """
    bodies = [body[::POINT_STEP] for body in _bodies(body_of_component, points)]
    for component in np.flatnonzero(areas >= MIN_COMPONENT_M2) + 1:
        if body_of_component[component] or not bodies:
            continue
        distances = [_excess_distance(points[component], body) for body in bodies]
        if min(distances) <= 0.0:
            body_of_component[component] = int(np.argmin(distances)) + 1


def _excess_distance(own: Array, body: Array) -> float:
    """Return the distance beyond reach, meters; components at or below 0 belong to the body."""
    box = np.maximum(body.min(axis=0) - own.max(axis=0), own.min(axis=0) - body.max(axis=0))
    if box.max() > MAX_COMPONENT_DISTANCE_M:
        return float(box.max())
    to_center = float(np.linalg.norm(body - np.median(own, axis=0), axis=-1).min())
    return min(to_center - MAX_COMPONENT_DISTANCE_M, _excess_gap(own, body))


def _excess_gap(own: Array, body: Array) -> float:
    """Return the gap between two point sets minus `MAX_LIMB_GAP_M`, meters."""
    subset = own[:: max(1, len(own) // POINT_STEP)]
    return float(np.linalg.norm(subset[:, np.newaxis] - body, axis=-1).min()) - MAX_LIMB_GAP_M
