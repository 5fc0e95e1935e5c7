"""Retarget hands: positions relative to the shoulders, scaled by the arms."""

from itertools import repeat

import numpy as np

from ..arrays import Array
from ..motion import world_poses
from .body import SIDES
from .hand_distance import Arms, match_meeting_hands
from .hand_heights import GroundHeights, ease_into_extension, keep_above_ground, pull_to_ground
from .limbs import Transfer, limb_pairs, reach_with_limb
from .placement import leg_length


def place_hands(transfer: Transfer, rotations: Array, root_positions: Array) -> Array:
    """Place the hands relative to the shoulders like the source's, scaled by the arm length.

    Hands near the ground keep their height above it and their support position; see
    `hand_heights`. Hands that meet in the source keep their distance, scaled by the arm length;
    see `hand_distance`.
    """
    source, target = transfer.source, transfer.target
    pairs = limb_pairs(source, target, "Arm")
    if not pairs:
        return rotations
    world = world_poses(target.skeleton, rotations, root_positions)
    source_positions = transfer.source_poses.positions
    scales = [
        target.limb_length(target_arm) / source.limb_length(source_arm)
        for source_arm, target_arm in pairs
    ]
    arm_vectors = [
        scale * (source_positions[:, source_arm[2]] - source_positions[:, source_arm[0]])
        for (source_arm, _), scale in zip(pairs, scales, strict=True)
    ]
    shoulders = np.stack([world.positions[:, target_arm[0]] for _, target_arm in pairs])
    lengths = np.array([target.limb_length(target_arm) for _, target_arm in pairs])
    hands = [source_positions[:, source_arm[2]] for source_arm, _ in pairs]
    ground = _ground(transfer)
    wanted = shoulders + arm_vectors
    if ground:
        wanted = np.stack(
            list(map(pull_to_ground, wanted, hands, shoulders, lengths, repeat(ground)))
        )
    if len(pairs) == len(SIDES):
        arms = Arms(shoulders, wanted, lengths)
        wanted = match_meeting_hands(arms, np.mean(scales) * (hands[0] - hands[1]))
    if ground:
        wanted = np.stack(list(map(keep_above_ground, wanted, hands, repeat(ground))))
        reached = map(ease_into_extension, wanted - shoulders, arm_vectors, lengths)
        wanted = shoulders + np.stack(list(reached))
    for (_, target_arm), targets in zip(pairs, wanted, strict=True):
        rotations = reach_with_limb(target, rotations, world, target_arm, targets)
    return rotations


def _ground(transfer: Transfer) -> GroundHeights | None:
    """Return the ground as hands need it; None without legs to estimate it."""
    placement = transfer.placement
    if placement.floors is None:
        return None
    leg = leg_length(transfer.source)
    return GroundHeights(placement, placement.floors, leg, transfer.frame_rate)
