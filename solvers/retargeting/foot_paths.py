"""Retarget feet: scaled ankle paths, soles above the ground, and no additional sliding."""

import numpy as np
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from ..arrays import Array, Flags
from ..motion import WorldPoses, world_poses
from ..rotations import IDENTITY, rotate
from ..signals import smoothstep
from .body import SIDES
from .hand_distance import distance_to_reach
from .leg_lengths import TargetLeg, level_ankles
from .limbs import Limb, Transfer, limb_extension, limb_pairs, reach_with_limb
from .placement import rests_on_ground
from .planting import planting_shift
from .soles import allowed_depths, sole_above_ground, with_sole
from .stances import foot_bone

MAX_DROP_FRACTION = 0.15
"""Maximum pelvis drop for feet to reach, as a fraction of the leg length. It guards feet out of
reach, such as those of a wrong frame, which would pull the pelvis to the ground."""
DROP_EASE_S = 0.15
"""Seconds over which the pelvis drop eases in and out. Chosen by hand: x0.5 costs nothing, x2
gains 0.1 %."""
STANDING_LEG_RAD, LYING_LEG_RAD = np.radians([50.0, 70.0])
"""Angles of a leg from vertical: full pelvis drop up to the first, none from the second."""
UP = np.array([0.0, 0.0, 1.0])


def place_feet(
    transfer: Transfer, rotations: Array, root_positions: Array, softness: float
) -> tuple[Array, Array]:
    """Make the ankles follow the source's paths, transformed by the placement.

    Feet of other shapes are corrected: each foot stands at its own height, ball and tip stay
    above the ground, and a standing foot slides as far as the source's, scaled.

    Parameters
    ----------
    transfer : Transfer
    rotations : shape (n_frames, n_joints, 4)
        Local rotations of the target.
    root_positions : shape (n_frames, 3), meters
        Positions of its topmost joint.
    softness : float
        Fraction of a leg kept in reserve, unless the source's leg is straighter.

    Returns
    -------
    The rotations with new legs, and the root positions with the pelvis drop.
    """
    source, target = transfer.source, transfer.target
    pairs = limb_pairs(source, target, "Leg")
    if not pairs:
        return rotations, root_positions
    before = world_poses(target.skeleton, rotations, root_positions)
    extensions = [
        limb_extension(source, transfer.source_poses, source_leg) for source_leg, _ in pairs
    ]
    lengths = [target.limb_length(target_leg) for _, target_leg in pairs]
    hips = [before.positions[:, target_leg[0]] for _, target_leg in pairs]
    wanted = [
        transfer.placement.points(transfer.source_poses.positions[:, source_leg[2]])
        for source_leg, _ in pairs
    ]
    if transfer.contacts is not None and len(pairs) == len(SIDES):
        distances = [
            extension * length for extension, length in zip(extensions, lengths, strict=True)
        ]
        wanted = _level_ankles(transfer, transfer.contacts, pairs, hips, wanted, distances)
        rotations, wanted = _keep_above_ground(
            transfer, transfer.contacts, rotations, before, wanted
        )
        before = world_poses(target.skeleton, rotations, root_positions)
    reaches = [
        length * np.maximum(1.0 - softness, extension)
        for length, extension in zip(lengths, extensions, strict=True)
    ]
    drop = pelvis_drop(hips, wanted, reaches, transfer.frame_rate)
    root_positions = root_positions - drop[:, None] * UP
    world = WorldPoses(before.rotations, before.positions - drop[:, None, None] * UP)
    for (_, target_leg), targets in zip(pairs, wanted, strict=True):
        rotations = reach_with_limb(target, rotations, world, target_leg, targets)
    return rotations, root_positions


def _level_ankles(
    transfer: Transfer,
    contacts: Flags,
    pairs: list[tuple[Limb, Limb]],
    hips: list[Array],
    ankles: list[Array],
    distances: list[Array],
) -> list[Array]:
    """Return the ankles, each at its standing height, and leveled for uneven legs."""
    source, placement = transfer.source, transfer.placement
    if transfer.stances:
        ankles = [
            ankle - placement.rise * (stance.ankle - placement.ankles[0]) * UP
            for ankle, stance in zip(ankles, transfer.stances, strict=True)
        ]
    source_leg = np.array([source.limb_length(leg) for leg, _ in pairs])
    excess = placement.rise * (source_leg - source_leg.mean())
    legs = zip(hips, ankles, distances, contacts.T, excess, strict=True)
    return level_ankles(*(TargetLeg(*leg) for leg in legs))


def _keep_above_ground(
    transfer: Transfer,
    contacts: Flags,
    rotations: Array,
    before: WorldPoses,
    ankles: list[Array],
) -> tuple[Array, list[Array]]:
    """Keep the feet above the ground, and match their sliding to the source's.

    Returns
    -------
    Local rotations with new feet, and new positions of the ankles.
    """
    source, target, placement = transfer.source, transfer.target, transfer.placement
    ground = placement.floors[1] if placement.floors else 0.0
    result = []
    for number, side in enumerate(SIDES):
        ankle, rotation = ankles[number], np.tile(IDENTITY, (len(before.positions), 1))
        if rests_on_ground(target):
            allowed = allowed_depths(source, transfer.source_poses, side, placement)
            sole = sole_above_ground(
                target, before, side, ankle, ground, allowed, transfer.frame_rate
            )
            rotations = with_sole(target, rotations, before, side, sole)
            ankle, rotation = ankle + sole.lift[:, None] * UP, sole.rotation
        source_leg = transfer.source_poses.positions[:, list(foot_bone(source, side))]
        foot, ball = foot_bone(target, side)
        bone = rotate(before.rotations[:, foot], target.rest[ball] - target.rest[foot])
        ankle = ankle + planting_shift(
            (source_leg[:, 0], source_leg[:, 1]),
            (ankle, ankle + rotate(rotation, bone)),
            contacts[:, number],
            placement.travel,
            transfer.frame_rate,
        )
        result.append(ankle)
    return rotations, result


def pelvis_drop(
    hips: list[Array], feet: list[Array], reaches: list[Array], frame_rate: float
) -> Array:
    """Return the smooth pelvis drop that lets all legs reach their feet.

    Parameters
    ----------
    hips, feet : of each leg, shape (n_frames, 3), meters
    reaches : of each leg, shape (n_frames,), meters
        Maximum length of the leg.
    frame_rate : float

    Returns
    -------
    NDArray, shape (n_frames,), meters
        Sufficient in every frame, except above the limit or where the leg is lying: a drop
        would not bring its foot nearer.
    """
    needed = np.zeros(len(hips[0]))
    for hip, foot, allowed in zip(hips, feet, reaches, strict=True):
        required = distance_to_reach(foot - hip, UP, allowed)
        required *= _standing_weight(hip - foot)
        needed = np.maximum(needed, np.minimum(required, MAX_DROP_FRACTION * allowed))
    window = 2 * round(0.5 * DROP_EASE_S * frame_rate) + 1
    # The moving mean of the moving maximum is never below the required drop.
    envelope = maximum_filter1d(needed, window, mode="nearest")
    return np.asarray(uniform_filter1d(envelope, window, mode="nearest"))


def _standing_weight(directions: Array) -> Array:
    """Return 1 for standing legs, 0 for lying ones, with a smooth transition, (n_frames,)."""
    length = np.maximum(np.linalg.norm(directions, axis=1), 1e-9)
    lying, standing = np.cos(LYING_LEG_RAD), np.cos(STANDING_LEG_RAD)
    return smoothstep(directions[:, 2] / length, lying, standing)
