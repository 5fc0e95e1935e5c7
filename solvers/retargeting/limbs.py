"""Bring feet and hands to where the source's are, grown with the limb."""

from dataclasses import dataclass
from itertools import repeat

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from ..motion import Motion, ReachSettings, Skeleton, WorldPoses, reach, world_poses
from .body import SIDES, Body
from .low_hands import Ground, above_ground, near_ground, within_reach
from .meeting_hands import Arms, meeting_hands, way_into_reach
from .placement import Placement, leg_length
from .uneven_legs import Leg, level_ankles

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Limb = tuple[int, int, int]

DEEPEST = 0.15
"""Part of the leg by which hips are lowered at most so that feet reach."""
EASE = 0.15
"""Seconds before and after over which hips are lowered."""
STANDS, LIES = np.radians([50.0, 70.0])
"""Angles of a leg from straight down: hips sink fully for the first, not for the second."""
UP = np.array([0.0, 0.0, 1.0])


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


def place_feet(
    transfer: Transfer, rotations: Array, places: Array, softness: float
) -> tuple[Array, Array]:
    """Let the ankles follow the source's paths, as the placement takes them.

    Parameters
    ----------
    transfer : Transfer
    rotations : shape (n_frames, n_joints, 4)
        Local ones of the target.
    places : shape (n_frames, 3), metres
        Of its topmost joint.
    softness : float
        Part of a leg kept in reserve, unless the source's own leg is straighter.

    Returns
    -------
    Other rotations of the legs, and other places where the hips had to be lowered.
    """
    source, target = transfer.source, transfer.target
    pairs = _limb_pairs(source, target, "Leg")
    if not pairs:
        return rotations, places
    before = world_poses(target.skeleton, rotations, places)
    stretches = [_stretch(source, transfer.seen, theirs) for theirs, _ in pairs]
    lengths = [target.limb_length(ours) for _, ours in pairs]
    hips = [before.positions[:, ours[0]] for _, ours in pairs]
    wanted = [
        transfer.placement.points(transfer.seen.positions[:, theirs[2]]) for theirs, _ in pairs
    ]
    if transfer.contacts is not None and len(pairs) == len(SIDES):
        theirs = np.array([source.limb_length(leg) for leg, _ in pairs])
        excess = transfer.placement.rise * (theirs - theirs.mean())
        straight = [
            stretch * length for stretch, length in zip(stretches, lengths, strict=True)
        ]
        legs = zip(hips, wanted, straight, transfer.contacts.T, excess, strict=True)
        wanted = level_ankles(*(Leg(*leg) for leg in legs))
    reaches = [
        length * np.maximum(1.0 - softness, stretch)
        for length, stretch in zip(lengths, stretches, strict=True)
    ]
    drop = hips_drop(hips, wanted, reaches, transfer.frame_rate)
    places = places - drop[:, None] * UP
    world = WorldPoses(before.rotations, before.positions - drop[:, None, None] * UP)
    for (_, ours), targets in zip(pairs, wanted, strict=True):
        rotations = limb_reaches(target, rotations, world, ours, targets)
    return rotations, places


def place_hands(transfer: Transfer, rotations: Array, places: Array) -> Array:
    """Let the hands be as far from the shoulders as the source's, for the length of the arm.

    Hands near the ground are as near to it as in the source, and lean on the same place; see
    `low_hands`. Hands that meet in the source meet, as far apart as there for the length of the
    arm; see `meeting_hands`.
    """
    source, target = transfer.source, transfer.target
    pairs = _limb_pairs(source, target, "Arm")
    if not pairs:
        return rotations
    world = world_poses(target.skeleton, rotations, places)
    seen = transfer.seen.positions
    growths = [target.limb_length(ours) / source.limb_length(theirs) for theirs, ours in pairs]
    ways = [
        growth * (seen[:, theirs[2]] - seen[:, theirs[0]])
        for (theirs, _), growth in zip(pairs, growths, strict=True)
    ]
    shoulders = np.stack([world.positions[:, ours[0]] for _, ours in pairs])
    lengths = np.array([target.limb_length(ours) for _, ours in pairs])
    hands = [seen[:, theirs[2]] for theirs, _ in pairs]
    ground = _ground(transfer)
    wanted = shoulders + ways
    if ground:
        wanted = np.stack(
            list(map(near_ground, wanted, hands, shoulders, lengths, repeat(ground)))
        )
    if len(pairs) == len(SIDES):
        arms = Arms(shoulders, wanted, lengths)
        wanted = meeting_hands(arms, np.mean(growths) * (hands[0] - hands[1]))
    if ground:
        wanted = np.stack(list(map(above_ground, wanted, hands, repeat(ground))))
        reached = map(within_reach, wanted - shoulders, ways, lengths)
        wanted = shoulders + np.stack(list(reached))
    for (_, ours), targets in zip(pairs, wanted, strict=True):
        rotations = limb_reaches(target, rotations, world, ours, targets)
    return rotations


def _ground(transfer: Transfer) -> Ground | None:
    """Return what hands must know of the ground; None where no legs tell where it is."""
    placement = transfer.placement
    if placement.floors is None:
        return None
    leg = leg_length(transfer.source)
    return Ground(placement, placement.floors, leg, transfer.frame_rate)


def _limb_pairs(source: Body, target: Body, part: str) -> list[tuple[Limb, Limb]]:
    """Return the limbs that both have, the source's first."""
    limbs = [(source.limb(side, part), target.limb(side, part)) for side in SIDES]
    return [(theirs, ours) for theirs, ours in limbs if theirs and ours]


def _stretch(body: Body, world: WorldPoses, limb: Limb) -> Array:
    """Return how straight a limb is: 1 for fully, shape (n_frames,)."""
    way = world.positions[:, limb[2]] - world.positions[:, limb[0]]
    return np.asarray(np.linalg.norm(way, axis=1) / body.limb_length(limb))


def hips_drop(
    hips: list[Array], feet: list[Array], reaches: list[Array], frame_rate: float
) -> Array:
    """Return by how much, smoothly, the hips must be lowered for all feet to be reached.

    Parameters
    ----------
    hips, feet : of each leg, shape (n_frames, 3), metres
    reaches : of each leg, shape (n_frames,), metres
        How far the leg may stretch.
    frame_rate : float

    Returns
    -------
    NDArray, shape (n_frames,), metres
        Not less than needed in any frame, unless that would be more than `DEEPEST`, or the
        leg lies: to sink would not bring its foot nearer.
    """
    needed = np.zeros(len(hips[0]))
    for hip, foot, allowed in zip(hips, feet, reaches, strict=True):
        lacking = way_into_reach(foot - hip, UP, allowed)
        lacking *= _upright(hip - foot)
        needed = np.maximum(needed, np.minimum(lacking, DEEPEST * allowed))
    window = 2 * round(0.5 * EASE * frame_rate) + 1
    # The mean over a window of the greatest within that window is nowhere too little.
    envelope = maximum_filter1d(needed, window, mode="nearest")
    return np.asarray(uniform_filter1d(envelope, window, mode="nearest"))


def _upright(ways: Array) -> Array:
    """Return 1 for legs that stand, 0 for those that lie, smoothly, shape (n_frames,)."""
    length = np.maximum(np.linalg.norm(ways, axis=1), 1e-9)
    lies, stands = np.cos(LIES), np.cos(STANDS)
    share = np.clip((ways[:, 2] / length - lies) / (stands - lies), 0.0, 1.0)
    return np.asarray(share * share * (3.0 - 2.0 * share))


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
