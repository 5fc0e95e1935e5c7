"""Move the ends of arms and legs to target positions."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Flags
from ..motion import Motion, ReachSettings, Skeleton, WorldPoses, reach
from .body import SIDES, HumanoidBody
from .placement import HipPlacement
from .stances import Stance

Limb = tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class Transfer:
    """Source, target and measured quantities for placing limbs."""

    source: HumanoidBody
    target: HumanoidBody
    source_poses: WorldPoses
    """World poses of the source."""
    placement: HipPlacement
    frame_rate: float
    contacts: Flags | None
    """Contacts of the source's feet, shape (n_frames, 2)."""
    stances: tuple[Stance, Stance] | None
    """Stances of the source's feet, if the rest pose does not show them."""


def limb_pairs(
    source: HumanoidBody, target: HumanoidBody, part: str
) -> list[tuple[Limb, Limb]]:
    """Return the limbs of both bodies in pairs, the source's first."""
    limbs = [(source.limb(side, part), target.limb(side, part)) for side in SIDES]
    return [
        (source_limb, target_limb)
        for source_limb, target_limb in limbs
        if source_limb and target_limb
    ]


def limb_extension(body: HumanoidBody, world: WorldPoses, limb: Limb) -> Array:
    """Return the extension of a limb: 1 for fully straight, shape (n_frames,)."""
    path = world.positions[:, limb[2]] - world.positions[:, limb[0]]
    return np.asarray(np.linalg.norm(path, axis=1) / body.limb_length(limb))


def reach_with_limb(
    body: HumanoidBody, rotations: Array, world: WorldPoses, limb: Limb, targets: Array
) -> Array:
    """Return the body's local rotations with a limb's end at the targets.

    Only the chain from the limb's parent to its end is solved, so that the time does not depend
    on the number of joints.
    """
    upper, hinge, end = limb
    skeleton = body.skeleton
    parent = skeleton.parents[upper]
    path = [end, *skeleton.ancestors(end)]
    joints = path[: path.index(parent) + 1][::-1]
    local = rotations[:, joints]
    local[:, 0] = world.rotations[:, parent]
    names = tuple(skeleton.names[joint] for joint in joints)
    chain = Skeleton(names, tuple(range(-1, len(joints) - 1)), skeleton.offsets[joints])
    solved = reach(
        Motion(chain, local, world.positions[:, parent], 1.0),
        (joints.index(upper), joints.index(hinge), joints.index(end)),
        targets,
        ReachSettings(softness=0.0),
    )
    result = rotations.copy()
    result[:, joints[1:]] = solved.rotations[:, 1:]
    return result
