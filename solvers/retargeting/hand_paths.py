"""Where the hands have to be: from their shoulders, from the ground, and from each other."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..motion import WorldPoses
from ..motion.humanoid import SIDES
from ..signals import smooth_gaussian, smoothstep
from .limbs import LIMB_SMOOTHING_S, Limb, Transfer
from .placement import leg_length

LOW_WRIST_FRACTION, HIGH_WRIST_FRACTION = 0.2, 0.4
"""Heights of the wrist, as fractions of the leg length. Below the first, the height above
ground is the source's, scaled by the legs; above the second, the ground has no influence.
Chosen by hand; `make sensitivity` varies them."""
SUPPORT_HEIGHT_FRACTIONS = (0.12, 0.18)
"""The same heights, as fractions of the leg length, for hands that support themselves on the
ground. Half and twice are no better (`make sensitivity`)."""
SUPPORT_SPEED, PASSING_SPEED = 0.25, 1.0
"""Speeds in leg lengths per second: low hands slower than the first support themselves on the
ground; hands faster than the second only pass. They guard hands that sweep over the ground,
which would be pulled to the place of the source's
(`test_hand_that_rolls_on_the_ground_supports_the_body`,
`test_hand_that_sweeps_over_the_ground_does_not_support_where_it_turns`)."""
MEETING_FRACTION = 0.15
"""Distance of both hands, as a fraction of the arm length, below which they meet. It guards
hands that nearly touch, which would keep part of the distance from other arms
(`test_hands_that_meet_in_the_source_meet`)."""
INDEPENDENT_FRACTION = 0.4
"""Distance of both hands, as a fraction of the arm length, above which they are independent.
Half and twice gain less than 1 % (`make sensitivity`)."""


@dataclass(frozen=True, eq=False)
class HandPath:
    """Where the hand of one side has to be.

    Attributes
    ----------
    side : str
    arm : Limb
        Of the target.
    length : float, meters
        Of that arm.
    wanted : shape (n_frames, 3), meters
        From the shoulder as in the source, scaled by the arm, or near the ground from there.
    least_heights : pair of shape (n_frames,), meters, or None
        Of elbow and wrist; None without a known ground.
    """

    side: str
    arm: Limb
    length: float
    wanted: Array
    least_heights: tuple[Array, Array] | None


class Meeting(NamedTuple):
    """How both hands have to be to each other."""

    separation: Array
    """From the right hand to the left, scaled by the arms, (n_frames, 3), meters."""
    weight: Array
    """1 where they meet, 0 where they are independent, (n_frames,)."""

    def wanted(self, left: HandPath, right: HandPath) -> Array:
        """Return where the left hand has to be from the right one, (n_frames, 3), meters."""
        free = left.wanted - right.wanted
        return np.asarray(free + self.weight[:, None] * (self.separation - free))


def find_hand_paths(transfer: Transfer, poses: WorldPoses) -> list[HandPath]:
    """Return the paths of the hands that both bodies have; `poses` are those of the target."""
    source, target = transfer.source, transfer.target
    positions, placement = transfer.source_poses.positions, transfer.placement
    paths = []
    for side in SIDES:
        source_arm, arm = source.limb(side, "Arm"), target.limb(side, "Arm")
        if not (source_arm and arm):
            continue
        length, hand = target.limb_length(arm), positions[:, source_arm[2]]
        scale = length / source.limb_length(source_arm)
        wanted = poses.positions[:, arm[0]] + scale * (hand - positions[:, source_arm[0]])
        least_heights = None
        if placement.floors is not None:
            (floor, ground), leg = placement.floors, leg_length(source)
            elbow_height, height = (positions[:, source_arm[1:], 2] - floor).T / leg
            rise = placement.rise * leg
            support = placement.points(hand)
            support[:, 2] = ground + rise * height
            weights = ground_weights(hand / leg, height, transfer.frame_rate)
            wanted = wanted + weights * (support - wanted)
            least_heights = (
                ground + rise * np.minimum(elbow_height, 0.0),
                ground + rise * np.minimum(height, LOW_WRIST_FRACTION),
            )
        paths.append(HandPath(side, arm, length, wanted, least_heights))
    return paths


def ground_weights(hand: Array, height: Array, frame_rate: float) -> Array:
    """Return how much the ground decides where a hand is, in each direction, (n_frames, 3).

    The lower the source's hand, the more the height follows the source's; the lower and slower
    it is, the more the place does. `hand` and `height` are in leg lengths.
    """
    velocity = np.gradient(hand, axis=0) * frame_rate if len(hand) > 1 else 0.0 * hand
    speed = smooth_gaussian(np.linalg.norm(velocity, axis=1), LIMB_SMOOTHING_S * frame_rate)
    supports = smoothstep(height, *reversed(SUPPORT_HEIGHT_FRACTIONS)) * smoothstep(
        speed, PASSING_SPEED, SUPPORT_SPEED
    )
    is_low = smoothstep(height, HIGH_WRIST_FRACTION, LOW_WRIST_FRACTION)
    return np.stack([supports, supports, is_low], axis=1)


def find_meeting(transfer: Transfer) -> Meeting | None:
    """Return how the hands meet; None unless both bodies have both arms."""
    source, target = transfer.source, transfer.target
    arms = [(source.limb(side, "Arm"), target.limb(side, "Arm")) for side in SIDES]
    lengths = [
        (source.limb_length(one), target.limb_length(other))
        for one, other in arms
        if one and other
    ]
    if len(lengths) < len(SIDES):
        return None
    scale = float(np.mean([after / before for before, after in lengths]))
    left, right = (
        transfer.source_poses.positions[:, arm[2]] for arm, _ in arms if arm is not None
    )
    separation = scale * (left - right)
    distance = np.linalg.norm(separation, axis=1) / np.mean(lengths, axis=0)[1]
    return Meeting(separation, smoothstep(distance, INDEPENDENT_FRACTION, MEETING_FRACTION))
