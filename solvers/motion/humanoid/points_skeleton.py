"""Build the skeleton of a body from tracked joint positions."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ...errors import InvalidMotionError
from ...rotations import fit_rotations, matrix_from_quaternion
from ..skeletons import Skeleton, Tracks, rest_direction

N_ITERATIONS = 5
"""Iterations of the Procrustes analysis. It bounds the run time."""


def skeleton_from_points(tracks: Tracks, parents: Sequence[int]) -> Skeleton:
    """Return the skeleton of tracked joints, with measured lengths and a T-pose as rest pose.

    The length of a bone is the median over the frames that show both ends. The children of a
    joint with several ones, such as the hips, form the mean shape (generalized Procrustes
    analysis [1]_: each frame is rotated onto the mean, which is then computed again), rotated
    onto the T-pose. A single child has the direction of the T-pose.

    Parameters
    ----------
    tracks : Tracks
        One point for each joint, in any order.
    parents : sequence of int, length n_points
        Index of each point's parent; -1 for the only root.

    Returns
    -------
    Skeleton
        Standing on the ground (Z = 0) at the origin, facing -Y. Joints that are never observed,
        or never together with their parent, are left out; their children get the next ancestor.

    Raises
    ------
    InvalidMotionError
        The points do not form one hierarchy, or no bone is ever observed.

    References
    ----------
    .. [1] Gower (1975). Generalized Procrustes analysis. Psychometrika 40(1).
       doi:10.1007/BF02291478
    """
    parents = _observed_parents(tracks, parents)
    order = _observed_order(tracks, parents)
    names = tuple(tracks.names[point] for point in order)
    new_parents = tuple(
        -1 if parents[point] < 0 else order.index(parents[point]) for point in order
    )
    positions = tracks.positions[:, order]
    offsets = np.zeros((len(order), 3))
    for joint in range(len(order)):
        children = [child for child, parent in enumerate(new_parents) if parent == joint]
        if not children:
            continue
        displacements = positions[:, children] - positions[:, [joint]]
        lengths = np.nanmedian(np.linalg.norm(displacements, axis=-1), axis=0)
        directions = np.array([rest_direction(names[child]) for child in children])
        shape = lengths[:, None] * directions
        offsets[children] = (
            _mean_shape(displacements, lengths, shape) if len(children) > 1 else shape
        )
    skeleton = Skeleton(names, new_parents, offsets)
    offsets[0, 2] = -skeleton.rest_positions[:, 2].min()
    return Skeleton(names, new_parents, offsets)


def _observed_parents(tracks: Tracks, parents: Sequence[int]) -> list[int]:
    """Return the nearest ancestor of each joint that is observed in any frame."""
    observed = tracks.visible.any(axis=0)
    result = list(parents)
    for point in range(len(result)):
        new_parents = set()
        while (
            result[point] >= 0
            and not observed[result[point]]
            and result[point] not in new_parents
        ):
            new_parents.add(result[point])
            if parents[result[point]] < 0:
                break
            result[point] = parents[result[point]]
    return result


def _observed_order(tracks: Tracks, parents: Sequence[int]) -> list[int]:
    """Return the points, parents first, that are observed together with their parents."""
    roots = [point for point, parent in enumerate(parents) if parent < 0]
    if len(roots) != 1:
        root_names = ", ".join(tracks.names[point] for point in roots)
        raise InvalidMotionError(
            f"Joints must form one hierarchy; these have no parent: {root_names or 'none'}."
        )
    order = roots
    for point in order:
        children = [child for child, parent in enumerate(parents) if parent == point]
        both = tracks.visible[:, [point]] & tracks.visible[:, children]
        order += [
            child for child, observed in zip(children, both.T, strict=True) if observed.any()
        ]
    if len(order) == 1:
        raise InvalidMotionError(
            f"{tracks.names[order[0]]} is never observed together with one of its children."
        )
    return order


def _mean_shape(displacements: Array, lengths: Array, directions: Array) -> Array:
    """Return the offsets of the children, shape (n_children, 3), aligned with `directions`."""
    complete = displacements[np.isfinite(displacements).all(axis=(1, 2))]
    shape = directions
    for _ in range(N_ITERATIONS if len(complete) else 0):
        rotations = matrix_from_quaternion(fit_rotations(shape, complete))
        aligned = np.einsum("fij,fpi->fpj", rotations, complete)  # rotated back
        aligned = aligned[np.isfinite(aligned).all(axis=(1, 2))]
        if not len(aligned):
            return directions
        shape = np.median(aligned, axis=0)
    lengths_now = np.linalg.norm(shape, axis=-1, keepdims=True)
    return np.asarray(lengths[:, None] * shape / np.where(lengths_now > 0.0, lengths_now, 1.0))
