"""The skeleton of a body of which only the positions of its joints were tracked."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...rotations import fit_rotations, matrix_from_quaternion
from ..skeletons import Skeleton, Tracks, rest_direction

Array = NDArray[np.float64]
ROUNDS = 5
"""Times that a shape is laid over its frames and averaged again."""


def skeleton_from_points(tracks: Tracks, parents: Sequence[int]) -> Skeleton:
    """Return the skeleton of tracked joints: lengths as measured, rest pose a standing T-pose.

    A bone is as long as the median over the frames that show both its ends. Where a joint has
    several children, as hips have, their places about it are those of the mean shape
    (generalised Procrustes analysis: each frame is turned onto the mean, which is then taken
    anew [1]_), turned towards the T-pose as a whole; a bone of its own points as it does in a
    T-pose.

    Parameters
    ----------
    tracks : Tracks
        One point for each joint, in any order.
    parents : sequence of int, length n_points
        The point that each hangs on; -1 for the only root.

    Returns
    -------
    Skeleton
        Standing on the ground (Z = 0) at the origin, facing -Y. A joint that is never seen has
        no place in it; what hangs on it hangs on the joint above. Nor has a joint that is never
        seen together with the one it hangs on.

    Raises
    ------
    InvalidMotionError
        The points do not form one tree, or no two of them are ever seen together.

    References
    ----------
    .. [1] Gower (1975). Generalized Procrustes analysis. Psychometrika 40(1).
       doi:10.1007/BF02291478
    """
    parents = _seen_parents(tracks, parents)
    order = _seen_tree(tracks, parents)
    names = tuple(tracks.names[point] for point in order)
    above = tuple(-1 if parents[point] < 0 else order.index(parents[point]) for point in order)
    positions = tracks.positions[:, order]
    offsets = np.zeros((len(order), 3))
    for joint in range(len(order)):
        children = [child for child, parent in enumerate(above) if parent == joint]
        if not children:
            continue
        ways = positions[:, children] - positions[:, [joint]]
        lengths = np.nanmedian(np.linalg.norm(ways, axis=-1), axis=0)
        usual = np.array([rest_direction(names[child]) for child in children])
        shape = lengths[:, None] * usual
        offsets[children] = _mean_shape(ways, lengths, shape) if len(children) > 1 else shape
    skeleton = Skeleton(names, above, offsets)
    offsets[0, 2] = -skeleton.rest_positions[:, 2].min()
    return Skeleton(names, above, offsets)


def _seen_parents(tracks: Tracks, parents: Sequence[int]) -> list[int]:
    """Return the nearest joint above each that is ever seen; the root stays what it is."""
    seen = tracks.visible.any(axis=0)
    found = list(parents)
    for point in range(len(found)):
        above = set()
        while found[point] >= 0 and not seen[found[point]] and found[point] not in above:
            above.add(found[point])
            if parents[found[point]] < 0:
                break
            found[point] = parents[found[point]]
    return found


def _seen_tree(tracks: Tracks, parents: Sequence[int]) -> list[int]:
    """Return the root, and then each point after its parent, where both are ever seen."""
    roots = [point for point, parent in enumerate(parents) if parent < 0]
    if len(roots) != 1:
        loose = ", ".join(tracks.names[point] for point in roots)
        raise InvalidMotionError(
            f"Joints must hang together in one tree; these hang on no other: {loose or 'none'}."
        )
    order = roots
    for point in order:
        children = [child for child, parent in enumerate(parents) if parent == point]
        both = tracks.visible[:, [point]] & tracks.visible[:, children]
        order += [child for child, seen in zip(children, both.T, strict=True) if seen.any()]
    if len(order) == 1:
        raise InvalidMotionError(
            f"{tracks.names[order[0]]} is never seen together with a joint that hangs on it."
        )
    return order


def _mean_shape(ways: Array, lengths: Array, usual: Array) -> Array:
    """Places of children about their joint, shape (n_children, 3), turned as `usual` is."""
    whole = ways[np.isfinite(ways).all(axis=(1, 2))]
    shape = usual
    for _ in range(ROUNDS if len(whole) else 0):
        turns = matrix_from_quaternion(fit_rotations(shape, whole))
        laid = np.einsum("fij,fpi->fpj", turns, whole)  # turned back
        laid = laid[np.isfinite(laid).all(axis=(1, 2))]
        if not len(laid):
            return usual
        shape = np.median(laid, axis=0)
    sizes = np.linalg.norm(shape, axis=-1, keepdims=True)
    return np.asarray(lengths[:, None] * shape / np.where(sizes > 0.0, sizes, 1.0))
