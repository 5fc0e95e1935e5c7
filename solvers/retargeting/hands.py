"""Bring hands to where the source's are, grown with the arms."""

from itertools import repeat

import numpy as np
from numpy.typing import NDArray

from ..motion import world_poses
from .body import SIDES
from .limbs import Transfer, limb_pairs, limb_reaches
from .low_hands import Ground, above_ground, near_ground, within_reach
from .meeting_hands import Arms, meeting_hands
from .placement import leg_length

Array = NDArray[np.float64]


def place_hands(transfer: Transfer, rotations: Array, places: Array) -> Array:
    """Let the hands be as far from the shoulders as the source's, for the length of the arm.

    Hands near the ground are as near to it as in the source, and lean on the same place; see
    `low_hands`. Hands that meet in the source meet, as far apart as there for the length of the
    arm; see `meeting_hands`.
    """
    source, target = transfer.source, transfer.target
    pairs = limb_pairs(source, target, "Arm")
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
