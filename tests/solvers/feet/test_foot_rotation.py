"""Feet that stand flat keep their rotation, if that is set; feet that roll do not."""

import numpy as np
import pytest

from solvers.feet import PlantSettings, find_legs, plant_feet
from solvers.motion import Motion, forward_kinematics
from solvers.rotations import IDENTITY, angle_between, quaternion_from_rotation_vector
from solvers.samples import walker_skeleton


@pytest.mark.parametrize(
    ("hold_rotation", "twist_deg", "least", "most"),
    [(True, 2.0, 0.0, 0.3), (False, 2.0, 0.9, 1.0), (True, 8.0, 0.9, 1.1)],
    ids=["held", "not set", "too fast to rest"],
)
def test_flat_foot_that_twists_slowly_is_held_if_set(hold_rotation, twist_deg, least, most):
    """Peak speeds of 13 and 50 degrees per second; a foot above 34 rolls."""
    twisting = twisting_foot(twist_deg)
    contacts = np.ones((twisting.n_frames, 2), dtype=np.bool_)

    settings = PlantSettings(hold_rotation=hold_rotation)

    planted = plant_feet(twisting, contacts, settings=settings).motion

    assert least < rms_turn(planted) / rms_turn(twisting) < most


def twisting_foot(degrees: float) -> Motion:
    """Return four seconds of standing while the left foot twists to both sides at 1 Hz."""
    skeleton, n_frames, rate = walker_skeleton(), 120, 30.0
    angles = np.radians(degrees) * np.sin(2.0 * np.pi * np.arange(n_frames) / rate)
    rotations = np.tile(IDENTITY, (n_frames, skeleton.n_joints, 1))
    rotations[:, find_legs(skeleton)[0].ankle] = quaternion_from_rotation_vector(
        np.outer(angles, [0.0, 0.0, 1.0])
    )
    height = skeleton.offsets[0] - [0.0, 0.0, skeleton.rest_positions[:, 2].min()]
    return Motion(skeleton, rotations, np.tile(height, (n_frames, 1)), rate)


def rms_turn(motion: Motion) -> float:
    """Return the rotation of the left foot from frame to frame, radians."""
    ankle = find_legs(motion.skeleton)[0].ankle
    rotations = forward_kinematics(motion).rotations[:, ankle]
    return float(np.sqrt(np.mean(angle_between(rotations[1:], rotations[:-1]) ** 2)))
