"""Takes that the sweeps do not hold: each is what one constant guards."""

import numpy as np
import pytest

from solvers.motion import Motion, Skeleton, Tracks, resample
from solvers.motion.humanoid import POSTURE_JOINTS, postures_from_motion
from solvers.motion.humanoid.body_size import estimate_bone_lengths, segment_lengths
from solvers.motion.humanoid.bone_directions import rates_from_directions
from solvers.motion.humanoid.foot_contacts import contacts_of_points
from solvers.motion.humanoid.posture_heading import normalize_postures
from solvers.motion.skeletons.shot_boundaries import find_shot_boundaries
from solvers.motion.skeletons.still_joints import still_joints
from solvers.rotations.representations import quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait
from solvers.signals import smooth_gaussian

RATE = 60.0


@pytest.fixture
def posture():
    """One posture of a walking adult, shape (20, 3)."""
    return postures_from_motion(walking_gait(GaitSettings(duration=1.0, frame_rate=RATE)))[0]


def test_foot_below_the_ground_for_some_frames_does_not_end_the_contact():
    feet = np.zeros((300, 2, 2, 3))
    feet[:, 1, :, 0] = 0.3
    feet[150:155, 0, :, 2] = -0.2

    in_contact = contacts_of_points(feet, RATE)

    assert in_contact[:, 1].all()


def test_foot_that_is_slow_in_the_air_only_has_no_contact():
    """It slides over the ground at 2 m/s, and hangs at half a meter for a third of a second."""
    feet = np.zeros((1200, 2, 2, 3))
    feet[..., 0] = 2.0 * np.arange(1200)[:, None, None] / RATE
    feet[600:620] = feet[600] + (0.0, 0.0, 0.5)

    assert not contacts_of_points(feet, RATE).any()


def test_dropped_camera_frame_of_an_actor_who_stands_is_no_shot_boundary(rng):
    positions = rng.normal(size=(1, 10, 3)) + rng.normal(scale=1e-4, size=(100, 10, 3))
    positions[50:] += (0.03, 0.0, 0.0)
    names = tuple(f"joint{number}" for number in range(10))

    assert find_shot_boundaries(Tracks(names, positions, RATE)) == ()


def test_prop_that_is_put_elsewhere_is_no_shot_boundary(rng):
    positions = rng.normal(scale=0.01, size=(100, 3, 3))
    positions[50:] += (1.0, 0.0, 0.0)

    assert find_shot_boundaries(Tracks(("bow", "grip", "tip"), positions, RATE)) == ()


def test_fast_movement_in_repeated_frames_is_no_shot_boundary(rng):
    """The frames next to each step repeat it: only farther ones show how fast the body is."""
    steps = np.zeros(200)
    steps[100:130:2] = 0.3
    positions = rng.normal(size=(1, 10, 3)) + np.cumsum(steps)[:, None, None] * (1.0, 0.0, 0.0)
    positions[:100] += rng.normal(scale=1e-4, size=(100, 10, 3))
    names = tuple(f"joint{number}" for number in range(10))

    assert find_shot_boundaries(Tracks(names, positions, RATE)) == ()


def test_noise_of_directions_hardly_changes_rates_at_high_frame_rates(rng):
    noise = rng.normal(scale=0.01, size=(480, 20, 3))

    assert rates_from_directions(noise, 240.0).std() < 0.1


def test_jitter_does_not_rotate_the_body(rng, posture):
    postures = posture + rng.normal(scale=0.01, size=(240, 20, 3))

    headings = normalize_postures(postures, RATE).headings

    assert np.degrees(headings).std() < 0.6


def test_unreliable_frames_do_not_change_bone_lengths(posture):
    postures = np.repeat(posture[None], 100, axis=0)
    reliability = np.ones(postures.shape[:2])
    postures[30:] *= 1.3
    reliability[30:] = 0.3

    lengths = estimate_bone_lengths(postures, reliability)

    assert np.abs(lengths - segment_lengths(posture[None])[0])[1:].max() < 1e-9


def test_few_reliable_frames_do_not_decide_bone_lengths(posture):
    postures = np.repeat(posture[None], 100, axis=0)
    reliability = np.full(postures.shape[:2], 0.3)
    postures[:5] *= 1.3
    reliability[:5] = 1.0

    lengths = estimate_bone_lengths(postures, reliability)

    assert np.abs(lengths - segment_lengths(posture[None])[0])[1:].max() < 1e-9


def test_movement_too_fast_for_the_new_rate_leaves_no_alias():
    time = np.arange(480) / 120.0
    positions = np.zeros((480, 1, 3))
    positions[:, 0, 0] = np.sin(2.0 * np.pi * 40.0 * time)

    resampled = resample(Tracks(("hand",), positions, 120.0), 30.0)

    assert np.abs(resampled.positions[20:-20]).max() < 0.002


def test_causal_smoothing_lags_as_documented():
    ramp = np.arange(200.0)

    lag = ramp - smooth_gaussian(ramp, 10.0, causal=True)

    assert lag[100] == pytest.approx(0.8 * 10.0, abs=0.5)


def test_rounding_in_a_file_is_no_movement_and_swaying_is(leg):
    angles = np.zeros((60, 4, 3))
    angles[:, 0, 0] = np.radians(0.005) * (-1.0) ** np.arange(60)
    angles[:, 1, 0] = np.radians(0.1) * np.sin(np.arange(60))
    rotations = quaternion_from_rotation_vector(angles)

    still = still_joints(Motion(leg, rotations, np.zeros((60, 3)), RATE))

    assert still.tolist() == [True, False, True, True]


def test_hand_ends_at_the_palm_not_at_the_finger_tips():
    motion = walking_gait(GaitSettings(duration=0.1, frame_rate=RATE))
    skeleton = motion.skeleton
    wrist = skeleton.names.index("LeftHand")
    n_joints = skeleton.n_joints
    fingers = Skeleton(
        (*skeleton.names, "LeftHandMiddle1", "LeftHandMiddle3"),
        (*skeleton.parents, wrist, n_joints),
        np.vstack([skeleton.offsets, [0.09, 0.0, 0.0], [0.08, 0.0, 0.0]]),
    )
    rotations = np.concatenate([motion.rotations, motion.rotations[:, [wrist, wrist]]], axis=1)
    with_fingers = Motion(fingers, rotations, motion.root_positions, RATE)

    hand, end = (
        postures_from_motion(with_fingers)[:, POSTURE_JOINTS.index(role)]
        for role in ("leftHand", "leftHandEnd")
    )

    np.testing.assert_allclose(np.linalg.norm(end - hand, axis=1), 0.09)
