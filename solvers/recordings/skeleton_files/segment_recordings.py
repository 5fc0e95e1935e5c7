"""Make a skeleton's motion of segments with positions and rotations in the world."""

from collections.abc import Mapping, Sequence

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError, InvalidMotionError
from ...motion import Motion, Skeleton, Tracks, find_humanoid_map
from ...progress import Progress, Remark, unwatched
from ...rotations import (
    inverse,
    matrix_from_quaternion,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)
from ..conventions import (
    MIN_BODY_JOINTS,
    estimate_axes_of_points,
    points_z_up,
    rotations_z_up_from_y_up,
    stand_upright,
    z_up_from_y_up,
)
from .segment_trees import tree_of_segments
from .world_poses import body_extent, motion_from_world_poses

POINTS_ONLY = "The origins of the segments come in as points, without their rotations"
MAX_JOINT_DRIFT = 0.003
"""Standard deviation of an origin seen from the segment above, relative to the size of the
body, from which it is at no joint. Measured: 5 mm of an adult. In a take of Theia3D the origin
of the trunk has 0.021, those at joints 0.0000001."""
JOINT_HEIGHT = 0.3
"""Fraction of the way to the origin at which that joint is, where the motion leaves it open.
Sweep: with it the head and arms of that take are at most 3.0 cm off, with 0.15 3.2 and with 0.5
4.1."""
MIN_SINGULAR_RATIO = 0.05
"""Singular values, relative to the largest, of directions that the motion leaves open.
Measured: in that take knees have 0.16 across their axis and 0.01 along it."""
LEFT_RIGHT = ("UpperLeg", "UpperArm", "Shoulder")
"""Roles whose left and right joints are on opposite sides of the body."""


def recording_from_segments(
    names: Sequence[str],
    positions: Array,
    rotations: Array,
    frame_rate: float,
    progress: Progress = unwatched,
    *,
    parents: Mapping[str, str] | None = None,
    default_up: str = "+Z",
) -> Motion | Tracks:
    """Return the motion of a body, or the origins of segments that are none.

    Bones are the mean of the origins seen from their parents, so the rest pose is that in
    which all segments are parallel to the world. It is turned to face -Y, and the actor to
    stand (`stand_upright`). Segments outside the tree, such as props, are left out.

    Parameters
    ----------
    names : of the segments
    positions : shape (n_frames, n_segments, 3), meters, in the file's axes; NaN where missing
    rotations : shape (n_frames, n_segments, 4), w x y z, in the file's axes
    frame_rate : float, hertz
    progress : Progress
        Receives a message about what is left out.
    parents : mapping of names to parents, or None
        Empty for the root. None: by the names (`tree_of_segments`).
    default_up : str
        Axis of the file that is up where no body shows it.

    Raises
    ------
    InvalidMotionError
        No segment is observed in any frame.
    """
    tree = tree_of_segments(names) if parents is None else _sorted_tree(parents)
    if len(tree) >= MIN_BODY_JOINTS:
        kept = [list(names).index(name) for name in tree]
        above = [list(tree).index(parent) if parent else -1 for parent in tree.values()]
        upright = rotations_z_up_from_y_up(rotations[:, kept])
        origins = _at_joints(z_up_from_y_up(positions[:, kept]), upright, above)
        try:
            motion = motion_from_world_poses(list(tree), above, origins, upright, frame_rate)
        except InvalidFileError:
            progress(1.0, Remark(f"Positions and rotations disagree. {POINTS_ONLY}"))
        else:
            if others := [name for name in names if name not in tree]:
                progress(
                    1.0, Remark(f"Left out, since they are on no bone: {', '.join(others[:5])}")
                )
            return face_forward(stand_upright(motion, progress))
    else:
        progress(1.0, Remark(POINTS_ONLY))
    if not np.isfinite(positions).all(axis=-1).any():
        raise InvalidMotionError("No segment is observed in any frame. Export it again.")
    axes = estimate_axes_of_points(positions, "", 1.0, default_up)
    return Tracks(tuple(names), points_z_up(positions, axes.up), frame_rate)


def _at_joints(positions: Array, rotations: Array, parents: Sequence[int]) -> Array:
    """Return the positions, with origins that are at no joint moved to one.

    An origin that moves relative to the segment above it, as that of a trunk whose origin is
    at the neck, is moved to the point that both segments carry along best [1]_.

    References
    ----------
    .. [1] Ehrig, Taylor, Duda, Heller (2006). A survey of formal methods for determining the
       centre of rotation of ball joints. J. Biomechanics 39(15).
    """
    moved = positions.copy()
    max_drift = MAX_JOINT_DRIFT * body_extent(positions)
    for joint, parent in enumerate(parents):
        if parent < 0:
            continue
        between = positions[:, joint] - positions[:, parent]
        complete = np.isfinite(between).all(axis=1)
        complete &= np.isfinite(rotations[:, [parent, joint]]).all(axis=(1, 2))
        carried = rotate(inverse(rotations[complete, parent]), between[complete])
        if not len(carried) or carried.std(axis=0).max() < max_drift:
            continue
        own = matrix_from_quaternion(rotations[complete, joint])
        above = matrix_from_quaternion(rotations[complete, parent])
        guess = JOINT_HEIGHT * carried.mean(axis=0)
        back = np.einsum("fji,fj->fi", own, above @ guess - between[complete])
        start = np.concatenate([guess, back.mean(axis=0)])
        equations = np.concatenate([above, -own], axis=2).reshape(-1, 6)
        left = between[complete].ravel() - equations @ start
        point = start + np.linalg.lstsq(equations, left, rcond=MIN_SINGULAR_RATIO)[0]
        moved[:, joint] += rotate(rotations[:, joint], point[3:])
    return moved


def face_forward(motion: Motion) -> Motion:
    """Return the same motion of a skeleton whose rest pose has the left side at +X."""
    rest = motion.skeleton.rest_positions
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    across = np.zeros(3)
    for part in LEFT_RIGHT:
        if {f"left{part}", f"right{part}"} <= roles.keys():
            across += rest[roles[f"left{part}"]] - rest[roles[f"right{part}"]]
    angle = np.arctan2(across[1], across[0])
    if not np.isfinite(angle) or abs(angle) < np.radians(1.0) or np.hypot(*across[:2]) == 0.0:
        return motion
    rotation = quaternion_from_rotation_vector(np.array([0.0, 0.0, -angle]))
    skeleton = Skeleton(
        motion.skeleton.names,
        motion.skeleton.parents,
        rotate(rotation, motion.skeleton.offsets),
    )
    rotations = multiply(multiply(rotation, motion.rotations), inverse(rotation))
    rotations[:, 0] = multiply(motion.rotations[:, 0], inverse(rotation))
    return Motion(skeleton, rotations, motion.root_positions, motion.frame_rate)


def _sorted_tree(parents: Mapping[str, str]) -> dict[str, str]:
    """Return the tree below the root with most segments, parents first."""
    children: dict[str, list[str]] = {}
    for name, parent in parents.items():
        children.setdefault(parent if parent in parents else "", []).append(name)
    trees = [_below(root, children) for root in children.get("", [])]
    largest = max(trees, key=len, default=[])
    return {name: parents[name] if name in largest[1:] else "" for name in largest}


def _below(root: str, children: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the root and everything below it; a circle is never reached from a root."""
    found = [root]
    for name in found:
        found += children.get(name, ())
    return found
