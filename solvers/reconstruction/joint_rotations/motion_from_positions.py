"""Fit the motion of a skeleton to tracked or reconstructed joint positions."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import Motion, Skeleton, Tracks, local_rotations, skeleton_from_points
from ...motion.humanoid import (
    MIN_JOINT_RELIABILITY,
    MIN_RELIABLE_FRAMES,
    posture_positions,
)
from ...motion.skeletons import MIN_BONE_M
from ...progress import Progress, unwatched
from ...rotations import IDENTITY, fit_rotations, rotate
from .clavicles import add_clavicle_joints
from .fit_to_positions import fit_to_positions
from .rotation_solver import RotationSolver
from .trunk_twist import LimbTwists, hinges_from_twists

ANKLE_WEIGHT = 25.0
"""Weight of an ankle in the last fit, so that standing feet stay in place. Sweep: x0.2 gains 1
% (subjects 2 and 5 of UI-PRMD), but ankles of real takes then miss by 2 cm. `make sensitivity`
varies it."""


def motion_from_positions(
    tracks: Tracks,
    parents: Sequence[int],
    reliability: Array | None = None,
    *,
    skeleton: Skeleton | None = None,
    twists: LimbTwists | None = None,
    refine: bool = True,
    progress: Progress = unwatched,
) -> Motion:
    """Fit the motion of a skeleton of constant bone lengths to joint positions.

    Bones are aimed one after another, and then all joints change a little at once, so that they
    come nearest to their observed positions, ankles above all (`fit_to_positions`). At first,
    pelvis and chest get the best-fit rotations of hips, shoulders, spine and neck
    (`fit_rotations`); the spine between them shares the twist. Other joints point at their
    child. The flexion plane of elbow or knee
    determines the axial rotation of an upper arm or a thigh. Where the limb is straight,
    flexion before and after, similar library poses and the trunk determine it
    (`rotations_from_flexion`). A thumb determines the axial rotation of its hand, whose palm
    and tip are smoothed. All other joints take the shortest rotation from their parent's.

    Parameters
    ----------
    tracks : Tracks
        One point for each joint, in any order.
    parents : sequence of int, length n_points
        The parent of each point; -1 for the only root.
    reliability : shape (n_frames, n_points), 0 to 1, optional
        Bone lengths and axial rotations are taken from reliable frames.
    skeleton : Skeleton, optional
        Of these points, in a T-pose that faces -Y; by default that of `skeleton_from_points`,
        with clavicles and a lower-spine joint (`add_clavicle_joints`).
    twists : LimbTwists, optional
        Axial rotations from similar library poses, weighted against the flexion planes; the
        only source if `ignore_flexion` is set.
    refine : bool
        Whether all joints change a little at the end; takes most of the time.
    progress : Progress

    Returns
    -------
    Motion
        Rotations are NaN where undefined, as in `motion_from_points`.

    Raises
    ------
    InvalidMotionError
        The points do not form a single tree with observed positions, or the skeleton has
        joints that are not among them.
    SolveCancelled
        Raised by `progress`.
    """
    reliability = np.ones(tracks.positions.shape[:2]) if reliability is None else reliability
    if reliability.shape != tracks.positions.shape[:2]:
        raise InvalidMotionError(
            f"Reliability needs shape {tracks.positions.shape[:2]}, not {reliability.shape}."
        )
    fitted = skeleton or add_clavicle_joints(
        skeleton_from_points(_without_unreliable(tracks, reliability), parents)
    )
    points = _points_of_joints(fitted, tracks.names)
    body = RotationSolver(
        fitted, tracks.positions[:, points], reliability[:, points], tracks.frame_rate
    )
    if twists is not None:
        body.hinges = hinges_from_twists(posture_positions(tracks), twists)
    body.solve_rotations()
    rotations = local_rotations(fitted, body.world)
    rotations[:, [not children for children in fitted.children]] = IDENTITY
    motion = Motion(fitted, rotations, body.observed[:, 0], tracks.frame_rate)
    if not refine:
        return motion
    return fit_to_positions(motion, body.observed, _position_weights(body), progress)


def _position_weights(body: RotationSolver) -> Array:
    """Return the weight of each joint in the last fit: its mean reliability; more for ankles.

    A weight that changed from frame to frame would shake joints that pull in turn. Fingers are
    too noisy to turn a hand.
    """
    mean = np.nan_to_num(body.reliability).mean(axis=0)
    for hand in body.hands:
        mean[body.skeleton.subtree(hand)[1:]] = 0.0
    mean[[leg.end for leg in body.legs().values()]] *= ANKLE_WEIGHT
    return np.asarray(mean)


def resize_skeleton(
    skeleton: Skeleton,
    tracks: Tracks,
    parents: Sequence[int],
    reliability: Array,
) -> Skeleton:
    """Return a skeleton with the bone lengths of other positions of its joints.

    Parameters
    ----------
    skeleton : Skeleton
        Of these points, in a T-pose of any heading.
    tracks, parents, reliability : as in `motion_from_positions`

    Returns
    -------
    Skeleton
        The same joints; those that are not among the points keep their offsets.
    """
    measured = skeleton_from_points(_without_unreliable(tracks, reliability), parents)
    offsets = skeleton.offsets.copy()
    known = [
        joint
        for joint in range(1, skeleton.n_joints)
        if _parent_name(measured, skeleton.names[joint]) == _parent_name(skeleton, joint)
    ]
    found = measured.offsets[[measured.index(skeleton.names[joint]) for joint in known]]
    rotation = fit_rotations(found, offsets[known][None])[0]
    if np.isfinite(rotation).all():
        offsets[known] = rotate(rotation, found)
    return Skeleton(skeleton.names, skeleton.parents, offsets)


def _parent_name(skeleton: Skeleton, joint: int | str) -> str | None:
    """Return the name of a joint's parent, or None if there is no such joint or parent."""
    if isinstance(joint, str):
        joint = skeleton.names.index(joint) if joint in skeleton.names else 0
    parent = skeleton.parents[joint]
    return skeleton.names[parent] if parent >= 0 else None


def _points_of_joints(skeleton: Skeleton, names: Sequence[str]) -> list[int]:
    """Return the point of each joint; a joint of zero length uses the point of its parent."""
    points: list[int] = []
    for joint, name in enumerate(skeleton.names):
        if name in names:
            points.append(list(names).index(name))
        elif np.linalg.norm(skeleton.offsets[joint]) <= MIN_BONE_M and joint > 0:
            points.append(points[skeleton.parents[joint]])
        else:
            raise InvalidMotionError(
                f"The skeleton has a joint that was not tracked: {name}. Use the skeleton of"
                " these points, or none."
            )
    return points


def _without_unreliable(tracks: Tracks, reliability: Array) -> Tracks:
    """Set unreliable positions to NaN, for joints with enough reliable ones."""
    is_reliable = (reliability > MIN_JOINT_RELIABILITY) & tracks.visible
    selected = is_reliable | (is_reliable.sum(axis=0) < MIN_RELIABLE_FRAMES)
    return tracks.with_positions(np.where(selected[..., None], tracks.positions, np.nan))
