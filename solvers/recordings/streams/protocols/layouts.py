"""Give a motion the bones of a protocol, in the T-pose that its rotations start from."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ....arrays import Array
from ....errors import InvalidMotionError
from ....motion import (
    Motion,
    Skeleton,
    find_humanoid_map,
    forward_kinematics,
    t_pose_alignment,
)
from ....motion.humanoid import ESSENTIAL_ROLES
from ....rotations import inverse, multiply, rotate
from . import mocopi, xsens
from .humanoid import PARENTS, parent_indices, standing


class StreamLayout(NamedTuple):
    """Bones of a protocol, parents first."""

    names: tuple[str, ...]
    parents: tuple[int, ...]
    roles: tuple[str, ...]
    """Humanoid role of each bone, "" for those that keep still."""


def _roles(named: dict[str, str], names: Sequence[str]) -> tuple[str, ...]:
    return tuple(named.get(name, "") for name in names)


def _limbs(sides: dict[str, str], parts: dict[str, str]) -> dict[str, str]:
    return {
        f"{prefix}{part}": f"{side}{role}"
        for prefix, side in sides.items()
        for part, role in parts.items()
    }


MOCOPI = StreamLayout(mocopi.NAMES, mocopi.PARENTS, _roles(
    {"root": "hips", "torso_1": "spine", "torso_4": "chest", "torso_7": "upperChest",
     "neck_1": "neck", "head": "head"}
    | _limbs({"l_": "left", "r_": "right"}, {
        "shoulder": "Shoulder", "up_arm": "UpperArm", "low_arm": "LowerArm", "hand": "Hand",
        "up_leg": "UpperLeg", "low_leg": "LowerLeg", "foot": "Foot", "toes": "Toes",
    }),
    mocopi.NAMES,
))  # fmt: skip
XSENS = StreamLayout(xsens.NAMES, xsens.PARENTS, _roles(
    {"Pelvis": "hips", "L5": "spine", "T12": "chest", "T8": "upperChest", "Neck": "neck",
     "Head": "head"}
    | _limbs({"Left": "left", "Right": "right"}, {
        "Shoulder": "Shoulder", "UpperArm": "UpperArm", "ForeArm": "LowerArm", "Hand": "Hand",
        "UpperLeg": "UpperLeg", "LowerLeg": "LowerLeg", "Foot": "Foot", "Toe": "Toes",
    }),
    xsens.NAMES,
))  # fmt: skip


def humanoid_layout(roles: Sequence[str], has_upper_chest: bool = True) -> StreamLayout:
    """Return the layout of humanoid roles that a skeleton has, parents first.

    Without a bone for the upper chest, the chest takes its rotation, as arms and neck do.
    """
    is_merged = not has_upper_chest and "upperChest" in roles
    names = tuple(
        role for role in PARENTS if role in roles and not (is_merged and role == "upperChest")
    )
    played = tuple("upperChest" if is_merged and name == "chest" else name for name in names)
    return StreamLayout(names, tuple(parent_indices(names)), played)


def motion_in_layout(
    motion: Motion,
    layout: StreamLayout | Callable[[Sequence[str]], StreamLayout] = humanoid_layout,
) -> Motion:
    """Return a motion with the bones of a layout, or of one that is made of its roles.

    Bones whose role the skeleton lacks keep the rotation of their parent; those between two
    roles divide the bone between these.

    Raises
    ------
    InvalidMotionError
        The skeleton is not that of a body, or the motion has gaps.
    """
    roles = find_humanoid_map(motion.skeleton)
    joints = roles.indices(motion.skeleton)
    if missing := sorted(set(ESSENTIAL_ROLES) - joints.keys()):
        raise InvalidMotionError(
            f"The skeleton has no joint for {', '.join(missing)}. Choose the recording of a"
            " body."
        )
    if not np.isfinite(motion.rotations).all() or not np.isfinite(motion.root_positions).all():
        raise InvalidMotionError("The motion has gaps. Clean it before it is sent.")
    layout = layout if isinstance(layout, StreamLayout) else layout(tuple(joints))
    alignment = t_pose_alignment(motion.skeleton, roles)
    poses = forward_kinematics(motion)
    rotated = multiply(poses.rotations, alignment)
    world = np.empty((motion.n_frames, len(layout.names), 4))
    for bone, (role, parent) in enumerate(zip(layout.roles, layout.parents, strict=True)):
        world[:, bone] = rotated[:, joints[role]] if role in joints else world[:, parent]
    local = multiply(inverse(world[:, np.maximum(layout.parents, 0)]), world)
    local[:, 0] = world[:, 0]
    skeleton = _t_pose(motion.skeleton, joints, alignment, layout)
    root_positions = poses.positions[:, joints["hips"]]
    return Motion(skeleton, local, root_positions, motion.frame_rate)


def _t_pose(
    skeleton: Skeleton, joints: dict[str, int], alignment: Array, layout: StreamLayout
) -> Skeleton:
    """Return the layout's skeleton, with the lengths of another one."""
    rest = skeleton.rest_positions
    offsets = np.zeros((len(layout.names), 3))
    for bone, role in enumerate(layout.roles):
        if not bone or role not in joints:
            continue
        chain = [bone]
        while layout.roles[layout.parents[chain[-1]]] not in joints:
            chain.append(layout.parents[chain[-1]])
        above = joints[layout.roles[layout.parents[chain[-1]]]]
        between = rotate(inverse(alignment[above]), rest[joints[role]] - rest[above])
        free = [each for each in chain if not offsets[each].any()]
        used = sum((offsets[each] for each in chain if each not in free), start=np.zeros(3))
        offsets[free] = (between - used) / len(free)
    return standing(layout.names, layout.parents, offsets)
