"""Bring feet to where the source's are, grown with the legs, and keep soles on the ground."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from ..motion import WorldPoses, world_poses
from ..rotations import IDENTITY, rotate
from .body import SIDES
from .limbs import Limb, Transfer, limb_pairs, limb_reaches, stretch
from .meeting_hands import way_into_reach
from .placement import rests_on_ground
from .planting import planting_shift
from .soles import allowed_depths, sole_above_ground, with_sole
from .standing_feet import foot_bone
from .uneven_legs import Leg, level_ankles

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

DEEPEST = 0.15
"""Part of the leg by which hips are lowered at most so that feet reach."""
EASE = 0.15
"""Seconds before and after over which hips are lowered."""
STANDS, LIES = np.radians([50.0, 70.0])
"""Angles of a leg from straight down: hips sink fully for the first, not for the second."""
UP = np.array([0.0, 0.0, 1.0])


def place_feet(
    transfer: Transfer, rotations: Array, places: Array, softness: float
) -> tuple[Array, Array]:
    """Let the ankles follow the source's paths, as the placement takes them.

    But for what feet of other shapes need: each stands at its own height, no ball or tip goes
    through the ground, and what stands slides as far as the source's, grown.

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
    pairs = limb_pairs(source, target, "Leg")
    if not pairs:
        return rotations, places
    before = world_poses(target.skeleton, rotations, places)
    stretches = [stretch(source, transfer.seen, theirs) for theirs, _ in pairs]
    lengths = [target.limb_length(ours) for _, ours in pairs]
    hips = [before.positions[:, ours[0]] for _, ours in pairs]
    wanted = [
        transfer.placement.points(transfer.seen.positions[:, theirs[2]]) for theirs, _ in pairs
    ]
    if transfer.contacts is not None and len(pairs) == len(SIDES):
        straight = [part * length for part, length in zip(stretches, lengths, strict=True)]
        wanted = _level(transfer, transfer.contacts, pairs, hips, wanted, straight)
        rotations, wanted = _on_soles(transfer, transfer.contacts, rotations, before, wanted)
        before = world_poses(target.skeleton, rotations, places)
    reaches = [
        length * np.maximum(1.0 - softness, part)
        for length, part in zip(lengths, stretches, strict=True)
    ]
    drop = hips_drop(hips, wanted, reaches, transfer.frame_rate)
    places = places - drop[:, None] * UP
    world = WorldPoses(before.rotations, before.positions - drop[:, None, None] * UP)
    for (_, ours), targets in zip(pairs, wanted, strict=True):
        rotations = limb_reaches(target, rotations, world, ours, targets)
    return rotations, places


def _level(
    transfer: Transfer,
    contacts: Flags,
    pairs: list[tuple[Limb, Limb]],
    hips: list[Array],
    ankles: list[Array],
    straight: list[Array],
) -> list[Array]:
    """Return the ankles, each at the height at which it stands, for what is known of it."""
    source, placement = transfer.source, transfer.placement
    if transfer.stances:
        ankles = [
            ankle - placement.rise * (stance.ankle - placement.ankles[0]) * UP
            for ankle, stance in zip(ankles, transfer.stances, strict=True)
        ]
    theirs = np.array([source.limb_length(leg) for leg, _ in pairs])
    excess = placement.rise * (theirs - theirs.mean())
    legs = zip(hips, ankles, straight, contacts.T, excess, strict=True)
    return level_ankles(*(Leg(*leg) for leg in legs))


def _on_soles(
    transfer: Transfer,
    contacts: Flags,
    rotations: Array,
    before: WorldPoses,
    ankles: list[Array],
) -> tuple[Array, list[Array]]:
    """Keep the feet above the ground, and let them slide as the source's.

    Returns
    -------
    Local rotations with other feet, and other places of the ankles.
    """
    source, target, placement = transfer.source, transfer.target, transfer.placement
    ground = placement.floors[1] if placement.floors else 0.0
    result = []
    for number, side in enumerate(SIDES):
        ankle, turn = ankles[number], np.tile(IDENTITY, (len(before.positions), 1))
        if rests_on_ground(target):
            allowed = allowed_depths(source, transfer.seen, side, placement)
            sole = sole_above_ground(
                target, before, side, ankle, ground, allowed, transfer.frame_rate
            )
            rotations = with_sole(target, rotations, before, side, sole)
            ankle, turn = ankle + sole.lift[:, None] * UP, sole.turn
        theirs = transfer.seen.positions[:, list(foot_bone(source, side))]
        foot, ball = foot_bone(target, side)
        way = rotate(before.rotations[:, foot], target.rest[ball] - target.rest[foot])
        ankle = ankle + planting_shift(
            (theirs[:, 0], theirs[:, 1]),
            (ankle, ankle + rotate(turn, way)),
            contacts[:, number],
            placement.travel,
            transfer.frame_rate,
        )
        result.append(ankle)
    return rotations, result


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
