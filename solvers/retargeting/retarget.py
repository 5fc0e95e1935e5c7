"""Retarget a motion to another skeleton."""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, Flags
from ..errors import InvalidMotionError
from ..motion import (
    HumanoidMap,
    Motion,
    Skeleton,
    WorldPoses,
    detect_contacts,
    forward_kinematics,
    world_poses,
)
from ..motion.humanoid import SIDES, with_standing_rest
from ..progress import Progress, Remark, unwatched, within
from ..rotations import IDENTITY
from ..settings import Choice, Settings, setting
from .body import SOURCE, TARGET, HumanoidBody, find_body, without_gaps
from .limbs import Transfer
from .map_checks import knees_bend_backward
from .place_feet import place_feet
from .place_hands import place_hands
from .placement import ankle_height, find_placement
from .pose_transfer import transfer_pose
from .root_motion import in_place, on_root_bone
from .stances import find_stances, with_level_soles


class RootMotion(Choice):
    """Handling of the travel of the body."""

    KEEP = "keep", "Keep the travel on the hips", "On Hips"
    IN_PLACE = "in place", "Remove the travel, so that the body moves in place"
    ROOT_BONE = "root bone", "Move the travel to the bone above the hips", "On Root Bone"


@dataclass(frozen=True, kw_only=True)
class RetargetSettings(Settings):
    """Settings of the retargeting of a motion to another rig."""

    root_motion: RootMotion = setting(
        RootMotion.KEEP, "Choose where to put the travel of the body"
    )  # fmt: skip
    travel_scale: float = setting(
        0.0,
        "Scale of the travel; 1 keeps the source's distances, 0 scales with the leg length",
        minimum=0.0, maximum=1000.0,
    )  # fmt: skip
    keep_feet: bool = setting(
        True, "Scale foot paths to the leg length to avoid sliding", label="Match Foot Contacts"
    )  # fmt: skip
    keep_hands: bool = setting(
        True,
        "Scale hand reach to the arm length; hands that meet in the source also meet here",
        label="Match Hand Reach",
    )  # fmt: skip
    to_ground: bool = setting(
        False,
        "Put the ground of the source at height 0, for sensors that are their own origin",
        label="Place on Floor",
    )  # fmt: skip
    softness: float = setting(
        0.005, "Fraction of the leg length kept in reserve; higher lowers the hips more",
        minimum=0.0, maximum=0.2, advanced=True, label="Leg Reserve",
    )  # fmt: skip
    travel_smoothing: float = setting(
        0.5, "Time over which the root path is smoothed; higher leaves more sway of steps on"
        " the hips",
        unit="s", minimum=0.0, maximum=10.0, advanced=True, label="Root Smoothing",
    )  # fmt: skip
    turn_root: bool = setting(
        True,
        "Also rotate the root bone to the heading of the body",
        advanced=True,
        label="Turn Root Bone",
    )


BACKWARD_KNEES = Remark(
    "The knees of the source bend backward. If left and right are mirrored, swap them in the"
    " map"
)


def retarget(
    motion: Motion,
    source_map: HumanoidMap,
    target_skeleton: Skeleton,
    target_map: HumanoidMap,
    *,
    settings: RetargetSettings = RetargetSettings(),
    progress: Progress = unwatched,
) -> Motion:
    """Return the motion retargeted to another skeleton.

    Both rigs are aligned with one T-pose, so that any rest pose and bone roll works
    (`t_pose_alignment`). Every body part with a role in both gets the source's world rotation;
    spines with other numbers of joints distribute it. The midpoint of the hip joints travels in
    proportion to the legs, with its height relative to the ankles of standing feet. Then
    a fit of all frames lets the feet follow the source's, scaled by the leg; if a leg is too
    short, the hips follow (`place_feet`). Another one lets the hands follow the source's,
    scaled by the arm (`place_hands`). Both are in the spirit of [1]_, least changes of a whole
    take under constraints. Joints without a role keep their rest rotation
    relative to their parents: twist bones, face, props.

    Parameters
    ----------
    motion : Motion
        Gaps stay gaps in the same joints.
    source_map : HumanoidMap
        Roles of the motion's joints.
    target_skeleton : Skeleton
    target_map : HumanoidMap
        Roles of its joints.
    settings : RetargetSettings
    progress : Progress

    Returns
    -------
    Motion
        Motion of `target_skeleton` with the source's frames. Joints above the hips keep their
        rest pose. The root carries the hips, since only the root of a Motion has positions; for
        "root bone" it also rotates to the facing direction.

    Raises
    ------
    InvalidMotionError
        A map has no hips or does not describe a body (see `map_checks`), or the target has no
        joint above the hips for "root bone".
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Gleicher (1998). Retargetting motion to new characters. SIGGRAPH, 33-42.
       doi:10.1145/280814.280820
    """
    motion = with_standing_rest(motion, source_map)
    source = find_body(motion.skeleton, source_map, SOURCE)
    if knees_bend_backward(motion, source_map.indices(motion.skeleton)):
        progress(0.0, BACKWARD_KNEES)
    target = find_body(target_skeleton, target_map, TARGET)
    if settings.root_motion is RootMotion.ROOT_BONE and target.joints["hips"] == 0:
        raise InvalidMotionError(
            "The target has no joint above the hips that could carry the travel. Keep it on the"
            " hips, or add a root bone."
        )
    progress(0.05, "Reading the pose")
    filled, gaps = without_gaps(motion, source)
    source_poses = forward_kinematics(filled)
    transfer = _compare_bodies(
        source, target, source_poses, _find_contacts(motion, source_map), motion, settings
    )
    progress(0.3, "Rotating the joints")
    rotations, missing = transfer_pose(transfer.source, source_poses, gaps, target)
    root_positions = _root_positions(transfer, rotations)
    progress(0.5, "Placing the feet")
    if settings.keep_feet:
        rotations, root_positions = place_feet(
            transfer, rotations, root_positions, settings.softness, within(progress, 0.5, 0.7)
        )
    progress(0.7, "Placing the hands")
    if settings.keep_hands:
        rotations = place_hands(
            transfer, rotations, root_positions, within(progress, 0.7, 0.85)
        )
    root_positions[~np.isfinite(motion.root_positions).all(axis=1)] = np.nan
    rotations[missing] = np.nan
    all_rotations = np.tile(IDENTITY, (motion.n_frames, target_skeleton.n_joints, 1))
    all_rotations[:, list(target.joint_indices)] = rotations
    result = Motion(target_skeleton, all_rotations, root_positions, motion.frame_rate)
    progress(0.9, "Applying root motion")
    result = _apply_root_motion(result, target_map, settings)
    progress(1.0, "Retargeted")
    return result


class LiveRetargeting:
    """Gives poses to another skeleton, one after the other, as `retarget` gives motions.

    The bodies are compared once. Feet and hands are not fitted to paths of the source, which
    later frames would be needed for.

    Parameters
    ----------
    motion : Motion
        Without gaps; the first seconds of the source.
    source_map, target_skeleton, target_map, settings : as in `retarget`

    Raises
    ------
    InvalidMotionError
        As in `retarget`.
    """

    def __init__(
        self,
        motion: Motion,
        source_map: HumanoidMap,
        target_skeleton: Skeleton,
        target_map: HumanoidMap,
        settings: RetargetSettings = RetargetSettings(),
    ) -> None:
        source = find_body(motion.skeleton, source_map, SOURCE)
        target = find_body(target_skeleton, target_map, TARGET)
        contacts = _find_contacts(motion, source_map)
        poses = forward_kinematics(without_gaps(motion, source)[0])
        self._target_skeleton = target_skeleton
        self._transfer = _compare_bodies(source, target, poses, contacts, motion, settings)

    def update(self, pose: Motion) -> Motion:
        """Return poses of the target; those of the source have its skeleton and no gaps."""
        source, target = self._transfer.source, self._transfer.target
        filled, gaps = without_gaps(pose, source)
        transfer = replace(self._transfer, source_poses=forward_kinematics(filled))
        rotations, _ = transfer_pose(source, transfer.source_poses, gaps, target)
        all_rotations = np.tile(IDENTITY, (pose.n_frames, self._target_skeleton.n_joints, 1))
        all_rotations[:, list(target.joint_indices)] = rotations
        root_positions = _root_positions(transfer, rotations)
        return Motion(self._target_skeleton, all_rotations, root_positions, pose.frame_rate)


def _find_contacts(motion: Motion, humanoid: HumanoidMap) -> Flags | None:
    joints = humanoid.indices(motion.skeleton)
    if not all(f"{side}Foot" in joints for side in SIDES):
        return None
    return detect_contacts(motion, humanoid)


def _compare_bodies(
    source: HumanoidBody,
    target: HumanoidBody,
    source_poses: WorldPoses,
    contacts: Flags | None,
    motion: Motion,
    settings: RetargetSettings,
) -> Transfer:
    """Return the stances of the source and the placement of the target."""
    stances = find_stances(source, target, source_poses, contacts, motion.frame_rate)
    if stances:
        source = with_level_soles(source, stances)
        height: float | None = float(np.mean([stance.ankle for stance in stances]))
    else:
        height = ankle_height(source, source_poses.positions, contacts)
    placement = find_placement(
        source,
        target,
        source_poses.positions,
        height,
        travel=settings.travel_scale,
        to_ground=settings.to_ground,
    )
    return Transfer(
        source, target, source_poses, placement, motion.frame_rate, contacts, stances
    )


def _root_positions(transfer: Transfer, rotations: Array) -> Array:
    """Return the positions of the target's root, shape (n_frames, 3), meters.

    The placement maps the midpoint of the source's hip joints to that of the target's.
    """
    source, target = transfer.source, transfer.target
    hips = transfer.source_poses.positions[:, source.hip_joints()].mean(axis=1)
    middle = transfer.placement.points(hips)
    origin = world_poses(target.skeleton, rotations, np.zeros_like(middle))
    return np.asarray(middle - origin.positions[:, target.hip_joints()].mean(axis=1))


def _apply_root_motion(
    motion: Motion, humanoid: HumanoidMap, settings: RetargetSettings
) -> Motion:
    if settings.root_motion is RootMotion.IN_PLACE:
        return in_place(motion, humanoid, settings.travel_smoothing)
    if settings.root_motion is RootMotion.ROOT_BONE:
        smoothing = settings.travel_smoothing
        return on_root_bone(motion, humanoid, smoothing, follow_heading=settings.turn_root)
    return motion
