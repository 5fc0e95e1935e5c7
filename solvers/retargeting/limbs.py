"""Bring the ends of arms and legs to places."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion, ReachSettings, Skeleton, WorldPoses, reach
from .body import SIDES, Body
from .placement import Placement
from .standing_feet import Stance

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Limb = tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class Transfer:
    """What is known when limbs are placed."""

    source: Body
    target: Body
    seen: WorldPoses
    """The source's."""
    placement: Placement
    frame_rate: float
    contacts: Flags | None
    """Of the source's feet, shape (n_frames, 2)."""
    stances: tuple[Stance, Stance] | None
    """Of the source's feet, where the rest pose does not tell."""


def limb_pairs(source: Body, target: Body, part: str) -> list[tuple[Limb, Limb]]:
    """Return the limbs that both have, the source's first."""
    limbs = [(source.limb(side, part), target.limb(side, part)) for side in SIDES]
    return [(theirs, ours) for theirs, ours in limbs if theirs and ours]


def stretch(body: Body, world: WorldPoses, limb: Limb) -> Array:
    """Return how straight a limb is: 1 for fully, shape (n_frames,)."""
    way = world.positions[:, limb[2]] - world.positions[:, limb[0]]
    return np.asarray(np.linalg.norm(way, axis=1) / body.limb_length(limb))


def limb_reaches(
    body: Body, rotations: Array, world: WorldPoses, limb: Limb, targets: Array
) -> Array:
    """Return the body's local rotations with a limb's end at the targets.

    Only the chain from the joint above the limb to its end is looked at, which makes bodies of
    many joints as fast as others.
    """
    upper, hinge, end = limb
    skeleton = body.skeleton
    above = skeleton.parents[upper]
    way = [end, *skeleton.ancestors(end)]
    joints = way[: way.index(above) + 1][::-1]
    local = rotations[:, joints]
    local[:, 0] = world.rotations[:, above]
    names = tuple(skeleton.names[joint] for joint in joints)
    chain = Skeleton(names, tuple(range(-1, len(joints) - 1)), skeleton.offsets[joints])
    found = reach(
        Motion(chain, local, world.positions[:, above], 1.0),
        (joints.index(upper), joints.index(hinge), joints.index(end)),
        targets,
        ReachSettings(softness=0.0),
    )
    result = rotations.copy()
    result[:, joints[1:]] = found.rotations[:, 1:]
    return result
