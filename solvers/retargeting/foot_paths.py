"""How the feet have to move: the source's paths, transformed, and when they stand."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Flags
from ..motion import Motion, forward_kinematics
from ..motion.humanoid import SIDES, UP
from .leg_lengths import TargetLeg, level_ankles
from .limbs import Limb, Transfer, limb_extension
from .placement import rests_on_ground
from .soles import SolePoint, allowed_depths, sole_points
from .stances import foot_bone

SELECTION_POWER = 8.0
"""Power of the speed ratio that selects ankle or ball as the standing point. Half and twice are
no better (`make sensitivity`)."""
MIN_STEP_M = 1e-9
"""Minimum length of a step in meters. It guards a division."""
MAX_REACH_FRACTION = 1.15
"""Farthest path of an ankle from its hip, in leg lengths. It guards feet out of reach, such as
those of a wrong frame, which would pull the root to the ground."""


@dataclass(frozen=True, eq=False)
class FootPath:
    """How the foot of one side has to move.

    Attributes
    ----------
    side : str
    leg : Limb
        Of the target.
    ankle : shape (n_frames, 3), meters
    in_contact : bool, shape (n_frames,)
    load : shape (n_frames - 1, 2)
        Fractions of ankle and ball in the standing point of the source, step by step.
    steps : shape (n_frames - 1, 3), meters
        Displacement of that point, scaled.
    soles : sequence of SolePoint
        Of the target; empty if its ground is unknown.
    heights : sequence of shape (n_frames,), meters
        Least height of each.
    """

    side: str
    leg: Limb
    ankle: Array
    in_contact: Flags
    load: Array
    steps: Array
    soles: Sequence[SolePoint]
    heights: Sequence[Array]


def find_foot_paths(transfer: Transfer, motion: Motion) -> list[FootPath]:
    """Return the paths of the feet that both bodies have; `motion` is that of the target."""
    source, target, placement = transfer.source, transfer.target, transfer.placement
    legs = [
        (side, source_leg, target_leg)
        for side in SIDES
        if (source_leg := source.limb(side, "Leg")) and (target_leg := target.limb(side, "Leg"))
    ]
    n_frames, contacts = motion.n_frames, transfer.contacts
    is_grounded = len(legs) == len(SIDES) and contacts is not None
    if contacts is None or not is_grounded:
        contacts = np.zeros((n_frames, len(SIDES)), dtype=np.bool_)
    ankles = [
        placement.points(transfer.source_poses.positions[:, leg[2]]) for _, leg, _ in legs
    ]
    if is_grounded:
        ankles = _level_ankles(transfer, contacts, motion, legs, ankles)
    positions = forward_kinematics(motion).positions
    ground = placement.floors[1] if placement.floors else 0.0
    paths = []
    for (side, _, leg), path in zip(legs, ankles, strict=True):
        reach = MAX_REACH_FRACTION * target.limb_length(leg)
        ankle, is_near = _within_reach(path, positions[:, leg[0]], reach)
        load, steps = _standing_steps(transfer, side)
        soles = sole_points(target, side) if is_grounded and rests_on_ground(target) else []
        depths = allowed_depths(source, transfer.source_poses, side, placement, len(soles))
        heights = [
            ground + sole.height - depth for sole, depth in zip(soles, depths, strict=True)
        ]
        in_contact = contacts[:, SIDES.index(side)] & is_near
        paths.append(FootPath(side, leg, ankle, in_contact, load, steps, soles, heights))
    return paths


def _within_reach(ankle: Array, hip: Array, reach: float) -> tuple[Array, Flags]:
    """Return a path of the ankle no farther from its hip than `reach`, and where it was so."""
    leg = ankle - hip
    distance = np.linalg.norm(leg, axis=1)
    shorter = np.minimum(reach / np.maximum(distance, 1e-9), 1.0)
    return hip + leg * shorter[:, None], distance <= reach


def _standing_steps(transfer: Transfer, side: str) -> tuple[Array, Array]:
    """Return the fractions of ankle and ball in the standing point, and its scaled steps.

    The slower of the source's ankle and ball stands.
    """
    joints = list(foot_bone(transfer.source, side))
    steps = np.diff(transfer.source_poses.positions[:, joints], axis=0)
    ankle, ball = np.linalg.norm(steps[..., :2], axis=-1).T + MIN_STEP_M
    on_ball = 1.0 / (1.0 + (ball / ankle) ** SELECTION_POWER)
    load = np.stack([1.0 - on_ball, on_ball], axis=1)
    return load, transfer.placement.travel * np.einsum("fp,fpi->fi", load, steps)


def _level_ankles(
    transfer: Transfer,
    contacts: Flags,
    motion: Motion,
    legs: Sequence[tuple[str, Limb, Limb]],
    ankles: list[Array],
) -> list[Array]:
    """Return the ankles, each at its standing height, and leveled for uneven legs."""
    source, target, placement = transfer.source, transfer.target, transfer.placement
    if transfer.stances:
        ankles = [
            ankle - placement.rise * (stance.ankle - placement.ankles[0]) * UP
            for ankle, stance in zip(ankles, transfer.stances, strict=True)
        ]
    positions = forward_kinematics(motion).positions
    lengths = np.array([source.limb_length(leg) for _, leg, _ in legs])
    excess = placement.rise * (lengths - lengths.mean())
    return level_ankles(
        *(
            TargetLeg(
                positions[:, leg[0]],
                ankle,
                limb_extension(source, transfer.source_poses, source_leg)
                * target.limb_length(leg),
                in_contact,
                longer,
            )
            for (_, source_leg, leg), ankle, in_contact, longer in zip(
                legs, ankles, contacts.T, excess, strict=True
            )
        )
    )
