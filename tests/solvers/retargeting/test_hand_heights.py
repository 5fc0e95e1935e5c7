"""Hands near the ground stay near it and do not penetrate it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from retargeted_motions import every_fourth, given_to, growth
from rigs import RIGS, mixamo

from solvers.motion import Motion, Skeleton, find_humanoid_map, forward_kinematics, reach
from solvers.recordings import read_recording
from solvers.rotations.representations import quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait

WRISTS = ("leftHand", "rightHand")
CLIPS = ("bd_depositFloorR_001", "bd_lieDownFloor_001", "bd_lieDownFloor_004")


def stretched(names: tuple[str, ...], factor: float) -> Skeleton:
    rig = mixamo()
    offsets = rig.offsets.copy()
    for name in names:
        for side in ("Left", "Right"):
            offsets[rig.index(f"mixamorig:{side}{name}")] *= factor
    return Skeleton(rig.names, rig.parents, offsets)


BODIES = {
    "default": mixamo(),
    "short legs": stretched(("Leg", "Foot"), 0.6),
    "long legs": stretched(("Leg", "Foot"), 1.4),
    "long arms": stretched(("ForeArm", "Hand"), 1.4),
    "long forearms": stretched(("Hand",), 1.4),
}


@pytest.mark.parametrize("clip", CLIPS)
@pytest.mark.parametrize("body", BODIES)
def test_wrists_and_elbows_do_not_penetrate_the_floor(recordings, clip, body):
    """Without correction, wrists are at -23.5 cm where the source's minimum is -1.2 cm."""
    motion = read_recording(recordings / f"mocap/hdm05/HDM_{clip}_120.amc")
    motion = every_fourth(motion)

    result = given_to(motion, BODIES[body])

    for role in (*WRISTS, "leftLowerArm", "rightLowerArm"):
        lowest = growth(motion, BODIES[body]) * role_position(motion, role)[:, 2].min()
        assert role_position(result, role)[:, 2].min() > min(lowest, 0.0) - 0.002


@pytest.mark.parametrize("body", BODIES)
def test_hand_height_scales_with_the_legs(recordings, body):
    """Without correction, the wrist's height above the ground was off by up to 27 cm.

    Arms that are too short for it reach down as far as they can.
    """
    motion = read_recording(recordings / "mocap/hdm05/HDM_bd_depositFloorR_001_120.amc")
    motion = every_fourth(motion)
    rig = BODIES[body]

    result = given_to(motion, rig)

    reference = role_position(motion, "rightHand")[:, 2]
    frame = int(reference.argmin())
    expected = growth(motion, rig) * reference[frame]
    height = role_position(result, "rightHand")[frame, 2]
    assert height > expected - 0.04
    assert height < expected + 0.04 or arm_extension(result, frame) > 0.99


def arm_extension(motion: Motion, frame: int) -> float:
    """Distance from shoulder to wrist, relative to the length of the arm: 1 is straight."""
    shoulder, elbow, wrist = (
        role_position(motion, f"right{role}")[frame]
        for role in ("UpperArm", "LowerArm", "Hand")
    )
    length = np.linalg.norm(elbow - shoulder) + np.linalg.norm(wrist - elbow)
    return float(np.linalg.norm(wrist - shoulder) / length)


def test_elbows_stay_slow_when_a_straight_arm_reaches_the_ground(recordings):
    """Without easing, elbows were up to 2.5 times as fast as the source's, scaled."""
    motion = every_fourth(read_recording(recordings / f"mocap/hdm05/HDM_{CLIPS[0]}_120.amc"))
    rig = mixamo()

    result = given_to(motion, rig)

    reference, actual = (
        np.linalg.norm(np.diff(role_position(one, "rightLowerArm"), 2, axis=0), axis=1).max()
        for one in (motion, result)
    )
    assert actual < 1.3 * growth(motion, rig) * reference


@pytest.mark.parametrize("family", RIGS)
def test_hands_that_support_the_body_do_not_slide(family):
    """On all fours, the shoulders rock back and forth above the hands."""
    source = on_all_fours()
    rig = RIGS[family](1.3)

    result = given_to(source, rig)

    for role in WRISTS:
        reference, actual = role_position(source, role), role_position(result, role)
        slide = np.ptp(actual, axis=0) - growth(source, rig) * np.ptp(reference, axis=0)
        assert np.abs(slide).max() < 0.005


def test_hands_of_a_walk_stay_unchanged():
    walk = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
    rig = stretched(("ForeArm", "Hand"), 1.4)

    result = given_to(walk, rig)

    for side in ("left", "right"):
        reference, actual = (
            role_position(motion, f"{side}Hand") - role_position(motion, f"{side}UpperArm")
            for motion in (walk, result)
        )
        ratio = np.linalg.norm(actual, axis=1) / np.linalg.norm(reference, axis=1)
        assert_allclose(ratio, ratio[0], rtol=1e-4)


def on_all_fours() -> Motion:
    """Level trunk, upright thighs, hands on the ground; the body rocks by 8 cm."""
    rig = mixamo()
    rotations = np.tile([1.0, 0, 0, 0], (120, rig.n_joints, 1))
    positions = np.tile([0.0, 0.0, 0.5], (120, 1))
    positions[:, 1] = 0.04 * np.sin(np.linspace(0.0, 4.0 * np.pi, 120))
    rotations[:, 0] = about_x(0.5 * np.pi)
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        rotations[:, rig.index(f"mixamorig:{side}Arm")] = quaternion_from_rotation_vector([
            0.0,
            -sign * 1.2,
            -sign * 0.8,
        ])
        rotations[:, rig.index(f"mixamorig:{side}UpLeg")] = about_x(-0.5 * np.pi)
        rotations[:, rig.index(f"mixamorig:{side}Leg")] = about_x(0.5 * np.pi)
    motion = Motion(rig, rotations, positions, 60.0)
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        arm = [rig.index(f"mixamorig:{side}{part}") for part in ("Arm", "ForeArm", "Hand")]
        target = np.tile([sign * 0.2, -0.5, 0.05], (120, 1))
        motion = reach(motion, (arm[0], arm[1], arm[2]), target)
    return motion


def about_x(angle: float) -> np.ndarray:
    return quaternion_from_rotation_vector([angle, 0.0, 0.0])


def role_position(motion: Motion, role: str) -> np.ndarray:
    joint = find_humanoid_map(motion.skeleton).indices(motion.skeleton)[role]
    return forward_kinematics(motion).positions[:, joint]
