"""Transfer world rotations from the joints of one body to those of another."""

from typing import NamedTuple

import numpy as np

from ..arrays import Array, Flags
from ..motion import WorldPoses
from ..rotations import IDENTITY, inverse, multiply, slerp
from .body import HumanoidBody
from .trunk_lean import leaning_swings

TRUNK = ("spine", "chest", "upperChest")
NECK = ("neck", "head")


class WorldRotation(NamedTuple):
    """World rotation of a body part, and the source joints that it depends on."""

    rotations: Array
    """From the canonical T-pose, shape (n_frames, 4)."""
    joints: frozenset[int]
    """Joints of the source's body."""


def transfer_pose(
    source: HumanoidBody, source_poses: WorldPoses, missing: Flags, target: HumanoidBody
) -> tuple[Array, Flags]:
    """Return local rotations of the target that match the orientations of the source.

    A role of both bodies gets the source's world rotation. The spine is a chain that starts at
    the hips: for different numbers of joints, the source's rotations are interpolated evenly
    along the target's, and the top matches the source. The same holds for the neck, between
    chest and head. A small swing of the spine matches the lean of the source
    (`leaning_swings`). All other joints keep their rest rotation relative to their parent.

    Parameters
    ----------
    source, target : HumanoidBody
    source_poses : WorldPoses
    missing : bool, shape (n_frames, n_source_joints)
        Where the source's local rotations are missing.

    Returns
    -------
    rotations : shape (n_frames, n_target_joints, 4)
    missing : bool, shape (n_frames, n_target_joints)
        Rotations that depend on missing ones.
    """
    targets = _apply_lean(
        source, source_poses, target, _target_rotations(source, source_poses.rotations, target)
    )
    n_frames = len(source_poses.rotations)
    skeleton = target.skeleton
    local = np.tile(IDENTITY, (n_frames, skeleton.n_joints, 1))
    target_missing = np.zeros((n_frames, skeleton.n_joints), dtype=np.bool_)
    posed: list[WorldRotation] = []
    for joint, parent in enumerate(skeleton.parents):
        parent_pose = posed[parent] if parent >= 0 else WorldRotation(IDENTITY, frozenset())
        rotation = targets.get(joint)
        if rotation is None:
            posed.append(parent_pose)
            continue
        # World rotations from the target's rest pose, as in `parent_pose`; not canonical ones.
        rotations = multiply(rotation.rotations, inverse(target.alignment[joint]))
        local[:, joint] = multiply(inverse(parent_pose.rotations), rotations)
        sources = sorted(rotation.joints ^ parent_pose.joints)
        target_missing[:, joint] = missing[:, sources].any(axis=1)
        posed.append(WorldRotation(rotations, rotation.joints))
    return local, target_missing


def _target_rotations(
    source: HumanoidBody, world: Array, target: HumanoidBody
) -> dict[int, WorldRotation]:
    """Return the canonical world rotation of each target joint that has one."""
    by_role = {
        role: _canonical_rotation(source, world, joint) for role, joint in source.joints.items()
    }
    available = dict(by_role)
    trunk = [role for role in TRUNK if role in by_role]
    top = by_role[trunk[-1]] if trunk else by_role["hips"]
    if trunk:
        chain = [by_role["hips"], *(by_role[role] for role in trunk)]
        available |= _spread(chain, [role for role in TRUNK if role in target.joints])
    if "head" in by_role:
        chain = [top, *(by_role[role] for role in NECK if role in by_role)]
        available |= _spread(chain, [role for role in NECK if role in target.joints])
    return {
        target.joints[role]: rotation
        for role, rotation in available.items()
        if role in target.joints
    }


def _apply_lean(
    source: HumanoidBody,
    source_poses: WorldPoses,
    target: HumanoidBody,
    targets: dict[int, WorldRotation],
) -> dict[int, WorldRotation]:
    """Return the rotations with a swing of the trunk that matches the source's lean."""
    trunk = [target.joints[role] for role in TRUNK if target.joints.get(role) in targets]
    rotated = {
        joint: multiply(rotation.rotations, inverse(target.alignment[joint]))
        for joint, rotation in targets.items()
    }
    hips = targets[target.joints["hips"]].rotations
    swings = leaning_swings(source, target, source_poses, hips, rotated, trunk)
    return targets | {
        joint: WorldRotation(multiply(swing, targets[joint].rotations), targets[joint].joints)
        for joint, swing in swings.items()
    }


def _canonical_rotation(source: HumanoidBody, world: Array, joint: int) -> WorldRotation:
    sources = frozenset((joint, *source.skeleton.ancestors(joint)))
    return WorldRotation(multiply(world[:, joint], source.alignment[joint]), sources)


def _spread(chain: list[WorldRotation], roles: list[str]) -> dict[str, WorldRotation]:
    """Interpolate the rotations of a chain, starting at its root, evenly over the roles."""
    spread = {}
    for number, role in enumerate(roles, start=1):
        lower, remainder = divmod(number * (len(chain) - 1), len(roles))
        if remainder == 0:
            spread[role] = chain[lower]
            continue
        start, stop = chain[lower], chain[lower + 1]
        fraction = np.array(remainder / len(roles))
        between = slerp(start.rotations, stop.rotations, fraction)
        spread[role] = WorldRotation(between, start.joints | stop.joints)
    return spread
