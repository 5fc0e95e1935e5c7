"""The goals of a fit that holds feet, hands, knees and hips in place with the least change."""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..motion import WorldPoses
from ..motion_fitting import FittedMotion, Goal
from ..motion_fitting.goals import (
    BonePoint,
    FollowPosition,
    FollowRotation,
    FollowSource,
    StayAtHeight,
    StayInPlace,
    StayStill,
    flexion_in_reserve,
    knee_limit,
)
from .limb_goals import LimbContact, elbows, limb_goals, limb_tolerances
from .plant_settings import PlantSettings
from .sole_contact import FootContact

ROOT_M = 0.01
"""Meters, for a leg of 0.9 m, by which the root may move. Chosen by hand: x2 lets the hips jerk
more; `make sensitivity` varies it."""
HIP_RAD = np.radians(4.0)
"""Radians of a hip, and of toes. Half and twice are no better (`make sensitivity`)."""
KNEE_RAD, LOOSE_KNEE_RAD = np.radians(3.0), np.radians(8.0)
"""Radians of a knee, with and without Protect Knees. Sweep: x2 makes knees jerk more;
`make sensitivity` varies both."""
HINGE_FADE = 2.5
"""Ratio of the time in which a change of a knee or elbow fades to that of other joints; its
acceleration counts by the square. Sweep: with 1, knees in martial arts accelerate 3.2 times as
much as before, with 2 1.4 times, with 3 1.1 times. Hips accelerate 0.97, 1.03 and 1.07 times,
and joints turn by 6.6, 7.1 and 7.6 degrees."""
ANKLE_RAD = np.radians(15.0)
"""Radians of an ankle, whose foot follows its own rotation in the world. Half and twice are no
better (`make sensitivity`)."""
FOOT_RAD = np.radians(2.5)
"""Radians of a foot in the world. X2 turns feet farther. Half and twice are no better
(`make sensitivity`)."""
ANKLE_M = 0.012
"""Meters, for a leg of 0.9 m, by which the ankle may leave its path in contact. 0.02 moves a
foot of CMU 06_01 by 17 cm, where a knee is nearly straight. Half and twice are no better
(`make sensitivity`)."""
CREEP_M = 0.01
"""Meters, for a leg of 0.9 m, by which a foot may creep in Max Hold Time. Sweep of the worst
drift within a contact of clean takes, 0.9 mm: x2 makes it 3.1, x0.5 0.2 and turns feet by 0.3
degrees more, at the same acceleration of knees. `make sensitivity` varies it."""
FLOOR_M = 0.002
"""Meters, for a leg of 0.9 m, by which a planted sole may be off the floor. Half and twice gain
less than 1 % (`make sensitivity`)."""
MAX_ROTATION_RAD_S = np.radians(8.0)
"""Radians per second by which a foot may turn while it rests flat. Sweep: 2 degrees make knees
before depth cameras jerk half as much again; `make sensitivity` varies it."""


def planting_goals(
    fitted: FittedMotion,
    contacts: Sequence[FootContact],
    limbs: Sequence[LimbContact],
    settings: PlantSettings,
    ankle_weights: Sequence[Array],
) -> list[Goal]:
    """Return the goals for a motion that is not changed yet.

    They come from the contacts of its feet, and of hands, knees and hips.
    `ankle_weights` say for each foot how firmly its ankle keeps its path, shape (n_frames,).
    """
    poses = fitted.poses
    goals = [
        goal
        for contact, weights in zip(contacts, ankle_weights, strict=True)
        for goal in (
            *_contact_goals(contact, settings),
            *_source_goals(fitted, poses, contact, settings, weights),
        )
    ]
    goals += limb_goals(fitted, limbs, settings, CREEP_M)
    return [*goals, _smoothness(fitted, contacts, limbs, settings)]


def _contact_goals(contact: FootContact, settings: PlantSettings) -> list[Goal]:
    """Return what the loaded sole has to meet."""
    creep = CREEP_M * contact.size / settings.hold
    goals: list[Goal] = [StayInPlace(contact.points, contact.step_load, contact.steps, creep)]
    if settings.floor and contact.on_floor.any():
        goals.append(
            StayAtHeight(
                contact.points,
                contact.load,
                contact.standing_heights,
                contact.floor,
                contact.on_floor,
                FLOOR_M * contact.size,
            )
        )
    if settings.hold_rotation and contact.flat.any():
        goals.append(
            StayStill(contact.leg.ankle, _in_all_directions(contact.flat), MAX_ROTATION_RAD_S)
        )
    return goals


def _source_goals(
    fitted: FittedMotion,
    poses: WorldPoses,
    contact: FootContact,
    settings: PlantSettings,
    weights: Array,
) -> list[Goal]:
    """Return what keeps foot and knee as they were recorded."""
    ankle = contact.leg.ankle
    point = BonePoint(ankle, np.zeros(3))
    goals: list[Goal] = [
        FollowPosition(
            point,
            poses.positions[:, ankle],
            _in_all_directions(weights * contact.contact),
            ANKLE_M * contact.size,
        ),
        FollowRotation(ankle, poses.rotations[:, ankle], FOOT_RAD),
    ]
    leg = fitted.motion.skeleton.rest_positions[list(contact.leg.chain)]
    reserve = flexion_in_reserve(leg, settings.softness)
    return [*goals, knee_limit(fitted, contact.leg.knee, ankle, reserve)]


def _in_all_directions(weight: Array) -> Array:
    return np.repeat(weight[:, None], 3, axis=1)


def _smoothness(
    fitted: FittedMotion,
    contacts: Sequence[FootContact],
    limbs: Sequence[LimbContact],
    settings: PlantSettings,
) -> FollowSource:
    """Return what keeps the change of each variable small and smooth."""
    size = float(np.mean([contact.size for contact in (*contacts, *limbs)]))
    knee = KNEE_RAD if settings.spare_knees else LOOSE_KNEE_RAD
    tolerances = {
        joint: tolerance
        for leg in (contact.leg for contact in contacts)
        for joint, tolerance in zip(
            (*leg.chain, leg.toe), (HIP_RAD, knee, ANKLE_RAD, HIP_RAD), strict=True
        )
        if joint is not None
    } | limb_tolerances(limbs)
    hinges = [contact.leg.knee for contact in contacts] + elbows(limbs)
    smoother = dict.fromkeys(hinges, HINGE_FADE)
    return FollowSource.of_joints(fitted, ROOT_M * size, tolerances, settings.blend, smoother)
