"""All joints come near their observed positions at once, ankles above all."""

import numpy as np
import pytest
from kinect_walks import true_positions

from solvers import samples
from solvers.motion import (
    SENSOR_JOINTS,
    Motion,
    Sensor,
    Tracks,
    forward_kinematics,
    joint_parents,
)
from solvers.motion.humanoid import posture_joints
from solvers.reconstruction.joint_rotations.fit_to_positions import fit_to_positions
from solvers.reconstruction.joint_rotations.motion_from_positions import motion_from_positions
from solvers.recordings import read_recording

NAMES = SENSOR_JOINTS[Sensor.KINECT_V1]
ANKLES = ("AnkleLeft", "AnkleRight")
REAL = (
    "irds/215_18_6_4_1_stand.txt",
    "irds/215_18_6_9_2_stand.txt",
    "irds/216_18_1_1_1_stand.txt",
    "kimore/JointPositionExercise1.csv",
    "kimore/JointPositionExercise5.csv",
)


@pytest.fixture
def walk() -> np.ndarray:
    return true_positions(samples, posture_joints)


def joint_positions(motion: Motion, names: tuple[str, ...]) -> np.ndarray:
    order = [motion.skeleton.index(name) for name in names]
    return forward_kinematics(motion).positions[:, order]


def position_errors(positions: np.ndarray, names=NAMES) -> Motion:
    return motion_from_positions(Tracks(names, positions, 30.0), joint_parents(names))


@pytest.mark.parametrize("file", REAL)
def test_ankles_of_real_takes_reach_observed_positions(recordings, file):
    """Without it, ankles miss by up to 12 cm and feet sink."""
    recording = read_recording(recordings / "kinect" / file).slice(0, 300)
    order = [recording.names.index(name) for name in ANKLES]
    observed = recording.tracks.positions[:, order]

    reached = joint_positions(
        motion_from_positions(recording.tracks, recording.parents), ANKLES
    )

    missed = np.linalg.norm(reached - observed, axis=-1)
    assert np.nanmean(missed) < 0.01
    assert np.nanpercentile(missed, 95) < 0.02


def test_hips_observed_low_do_not_push_feet_through_the_floor(walk):
    low = walk.copy()
    above = [index for index, name in enumerate(NAMES) if not name.startswith(("Ank", "Foot"))]
    low[40:60, above, 2] -= 0.06
    order = [NAMES.index(name) for name in ANKLES]

    reached = joint_positions(position_errors(low), ANKLES)

    assert np.linalg.norm(reached - low[:, order], axis=-1)[40:60].max() < 0.02


def test_pelvis_is_offset_for_straight_legs_and_knees_stay(walk):
    """Observed legs are 6 cm too short: flexed knees would move forward by 16 cm."""
    standing = np.repeat(walk[:1], 40, axis=0)
    for side, across in (("Left", 0.1), ("Right", -0.1)):
        for part, height in (("Hip", 0.92), ("Knee", 0.5), ("Ankle", 0.1)):
            standing[:, NAMES.index(part + side)] = (across, 0.0, height)
        standing[:, NAMES.index(f"Foot{side}")] = (across, -0.15, 0.05)
    standing[:, NAMES.index("HipCenter")] = (0.0, 0.0, 0.95)
    above = [index for index, name in enumerate(NAMES) if standing[0, index, 2] > 0.6]
    short = standing.copy()
    short[15:25, above, 2] -= 0.06

    motion = position_errors(short)

    knees = joint_positions(motion, ("KneeLeft", "KneeRight"))
    order = [NAMES.index(name) for name in ("KneeLeft", "KneeRight")]
    assert np.abs((knees - short[:, order])[..., 1])[18:22].max() < 0.1


def test_matching_ankles_stay_unchanged(walk):
    once = position_errors(walk)
    names = tuple(name for name in once.skeleton.names if name in NAMES)
    again = np.array(walk)
    again[:, [NAMES.index(name) for name in names]] = joint_positions(once, names)

    twice = joint_positions(position_errors(again), names)

    assert np.linalg.norm(twice - joint_positions(once, names), axis=-1).max() < 0.02


@pytest.fixture
def gait():
    return samples.walking_gait(samples.GaitSettings(duration=0.5, frame_rate=30.0))


def errors(motion, positions):
    return np.linalg.norm(forward_kinematics(motion).positions - positions, axis=-1)


def turned(gait, rng, size=0.05):
    """Another motion of the same skeleton: all joints turned by some degrees."""
    rotations = gait.rotations + size * rng.normal(size=gait.rotations.shape)
    rotations /= np.linalg.norm(rotations, axis=-1, keepdims=True)
    return gait.with_poses(rotations, gait.root_positions + 0.02)


def test_positions_that_the_skeleton_can_reach_are_reached(gait):
    positions = forward_kinematics(gait).positions
    near = turned(gait, np.random.default_rng(0))

    found = fit_to_positions(near, positions, np.ones(positions.shape[1]))

    assert errors(near, positions).mean() > 0.03
    assert errors(found, positions).mean() < 0.2 * errors(near, positions).mean()


def test_a_motion_that_is_there_stays(gait):
    positions = forward_kinematics(gait).positions

    found = fit_to_positions(gait, positions, np.ones(positions.shape[1]))

    np.testing.assert_allclose(found.rotations, gait.rotations, atol=1e-9)
    np.testing.assert_allclose(found.root_positions, gait.root_positions, atol=1e-9)


def test_heavier_joints_come_nearer(gait):
    rng = np.random.default_rng(1)
    positions = forward_kinematics(gait).positions
    positions = positions + 0.03 * rng.normal(size=positions.shape)
    joint = gait.skeleton.index("LeftFoot")
    even = np.ones(positions.shape[1])
    heavy = even.copy()
    heavy[joint] = 20.0

    one, other = (
        errors(fit_to_positions(gait, positions, weights), positions)[:, joint].mean()
        for weights in (even, heavy)
    )

    assert other < 0.5 * one


def test_missing_joints_and_frames_are_ignored(gait):
    positions = forward_kinematics(gait).positions.copy()
    near = turned(gait, np.random.default_rng(2))
    rotations = near.rotations.copy()
    rotations[3] = np.nan
    near = near.with_poses(rotations, near.root_positions)
    positions[5] = np.nan

    found = fit_to_positions(near, positions, np.ones(positions.shape[1]))

    assert np.isnan(found.rotations[3]).all()
    assert np.isfinite(found.rotations[5]).all()
    known = [0, 1, 2, 4, 6]
    assert errors(found, positions)[known].mean() < 0.2 * errors(near, positions)[known].mean()


def test_take_without_any_known_joint_stays(gait):
    positions = np.full((gait.n_frames, gait.n_joints, 3), np.nan)

    found = fit_to_positions(gait, positions, np.ones(gait.n_joints))

    np.testing.assert_array_equal(found.rotations, gait.rotations)
