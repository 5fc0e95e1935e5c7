"""Feet stand level on the ground, do not sink into it, and slide no more than the source's."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from retargeted_motions import every_fourth, given_to, growth, min_foot_steps
from rigs import RIGS, child

from solvers.motion import (
    Motion,
    Skeleton,
    detect_contacts,
    find_humanoid_map,
    foot_points,
    forward_kinematics,
)
from solvers.recordings import read_recording
from solvers.rotations.representations import (
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)
from solvers.samples import GaitSettings, walking_gait

BODIES = {**RIGS, "Child": child}
CLIPS = (
    "bd_squat1Reps_001",
    "bd_hopBothLegs1hops_003",
    "bd_sneak2StepsLStart_001",
    "bd_kickLFront1Reps_003",
)
DOWN = np.radians(10.0)
WALK = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))


@pytest.mark.parametrize("clip", CLIPS)
@pytest.mark.parametrize("family", BODIES)
def test_feet_do_not_sink_or_slide_more_than_the_source(recordings, clip, family):
    """Without correction, balls were up to 3 cm in the ground; only ankles followed."""
    motion = every_fourth(read_recording(recordings / f"mocap/hdm05/HDM_{clip}_120.amc"))
    rig = BODIES[family]()

    result = given_to(motion, rig)

    balls = foot_points(rig, find_humanoid_map(rig))[:, 1]
    lowest = forward_kinematics(result).positions[:, balls, 2].min(axis=0)
    assert (lowest - rig.rest_positions[balls, 2]).min() > -0.005
    contacts = detect_contacts(motion)
    held = contacts[1:] & contacts[:-1]
    reference, actual = (min_foot_steps(one)[held].mean() for one in (motion, result))
    assert actual < 1.02 * growth(motion, rig) * reference


def test_soles_are_level_for_any_feet_of_the_rest_pose():
    """Feet of the source's rest pose point down by 10 degrees more than in stance."""
    plain = standing()
    drawn = with_feet_drawn_down(plain)
    assert_allclose(
        forward_kinematics(drawn).positions[:, 1:], forward_kinematics(plain).positions[:, 1:]
    )
    rig = RIGS["Unreal"]()

    default, other = given_to(plain, rig), given_to(drawn, rig)

    feet = foot_points(rig, find_humanoid_map(rig))
    for motion in (default, other):
        heights = forward_kinematics(motion).positions[:, feet, 2]
        assert_allclose(heights, heights[0] * np.ones((60, 1, 1)), atol=1e-3)
        level = heights - rig.rest_positions[feet, 2]
        assert_allclose(level[..., 0], level[..., 1], atol=2e-3)


def test_body_with_hips_at_the_origin_repeats_its_own_steps(recordings):
    """Its rest pose defines no ground, for source and target."""
    motion = every_fourth(
        read_recording(recordings / "mocap/hdm05/HDM_bd_sneak2StepsLStart_001_120.amc")
    )

    again = given_to(motion, motion.skeleton)

    joints = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    feet = [joints[f"{side}{part}"] for side in ("left", "right") for part in ("Foot", "Toes")]
    assert angle_between(again.rotations, motion.rotations)[:, feet].max() < 1e-6


def standing() -> Motion:
    """Two seconds on both feet, breathing; hips at 0 in the rest pose, as in Acclaim."""
    walker = WALK.skeleton
    offsets = walker.offsets.copy()
    positions = np.tile(offsets[0], (60, 1))
    offsets[0] = 0.0
    rig = Skeleton(walker.names, walker.parents, offsets)
    rotations = np.tile([1.0, 0, 0, 0], (60, rig.n_joints, 1))
    spine = find_humanoid_map(rig).indices(rig)["spine"]
    rotations[:, spine] = quaternion_from_rotation_vector(
        np.sin(np.linspace(0.0, 6.0, 60))[:, None] * np.array([0.02, 0.0, 0.0])
    )
    return Motion(rig, rotations, positions, 30.0)


def with_feet_drawn_down(motion: Motion) -> Motion:
    """The same motion with other feet in the rest pose."""
    rig = motion.skeleton
    joints = find_humanoid_map(rig).indices(rig)
    rotation = quaternion_from_rotation_vector([DOWN, 0.0, 0.0])
    back = quaternion_from_rotation_vector([-DOWN, 0.0, 0.0])
    offsets, rotations = rig.offsets.copy(), motion.rotations.copy()
    for side in ("left", "right"):
        foot = joints[f"{side}Foot"]
        below = rig.subtree(foot)[1:]
        offsets[below] = rotate(rotation, offsets[below])
        rotations[:, foot] = multiply(rotations[:, foot], back)
    return Motion(
        Skeleton(rig.names, rig.parents, offsets), rotations, motion.root_positions, 30.0
    )
