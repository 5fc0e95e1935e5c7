"""Capture a motion from depth images, without an initial pose or body."""

import tracemalloc

import numpy as np
import pytest
from drawn_bodies import CAMERA, NATURAL, posed, recorded, waving
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from solvers.depth_scene.floor import FloorPlane
from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.coordinates import COORDINATES
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.motion import SCENE_FROM_CAMERA, body_motion, body_skeleton
from solvers.depth_tracking.body.motion_prior import load_motion_prior
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.capturing.capture import Capture, CaptureSettings, capture
from solvers.depth_tracking.capturing.choose_poses import choose_poses, nearest_tracked
from solvers.depth_tracking.capturing.smooth_take import smooth_take
from solvers.errors import InvalidMotionError, SolveCancelled
from solvers.motion import find_humanoid_map, forward_kinematics

BODY = default_body()


def joints_of(poses):
    return joint_positions(BODY, segment_frames(BODY, poses))


@pytest.fixture(scope="module")
def captured() -> Capture:
    return capture(recorded(waving(24)), BODY)


def test_capture_finds_the_first_pose_and_follows_the_actor(captured):
    truth = joints_of(waving(24))
    assert np.linalg.norm(captured.joints.positions - truth, axis=-1).mean() < 0.03
    assert captured.joints.names == JOINTS
    assert captured.low_confidence.shape == (24, 21)
    assert captured.residual.max() < 0.03 and captured.coverage.min() > 0.75


def test_motion_has_the_tracked_joint_positions(captured):
    world = forward_kinematics(captured.motion).positions

    expected = captured.joints.positions @ SCENE_FROM_CAMERA.T
    assert_allclose(world, expected, atol=1e-9)


def test_left_right_swap_in_a_recording_is_corrected():
    """Legs are invisible for 12 frames from frame 8 on, so the tracker fails there."""
    truth = waving(30)
    truth[:, COORDINATES.index("rightHumerusZ")] = np.linspace(0.2, 1.4, 30)
    recording = recorded(truth)

    def read(frame):
        image = recording.frame(frame).copy()
        if 8 <= frame < 14:
            image[:, 80:] = 0.0
        return image

    found = capture(DepthRecording(CAMERA, 30, 30.0, read), BODY)

    errors = np.linalg.norm(found.joints.positions - joints_of(truth), axis=-1)
    assert errors[20:].mean() < 0.04
    assert errors[:8].mean() < 0.04


def test_capture_bridges_and_flags_empty_frames():
    truth = waving(20)
    recording = recorded(truth)

    def read(frame):
        empty = frame in {0, 1, 9, 10, 11}
        return np.zeros((120, 160), np.float32) if empty else recording.frame(frame)

    found = capture(DepthRecording(CAMERA, 20, 30.0, read), BODY)

    assert found.low_confidence[[0, 1, 9, 10, 11]].all()
    assert not found.low_confidence[[5, 15]].all()
    assert np.isnan(found.residual[10])
    assert np.isfinite(found.poses).all()
    errors = np.linalg.norm(found.joints.positions - joints_of(truth), axis=-1)
    assert errors[9:12].mean() < 0.06


def test_capture_uses_the_motion_prior_when_requested():
    """The prior pulls an invisible arm to typical poses of arms; callers may pass a prior."""
    truth = waving(4)
    found = [
        capture(recorded(truth), BODY, motion_prior=given,
                settings=CaptureSettings(backward=False, recorded=expected)).poses
        for given, expected in ((None, False), (None, True), (load_motion_prior(), False))
    ]  # fmt: skip
    assert np.abs(found[0] - found[1]).max() > 1e-4
    assert_allclose(found[1], found[2], atol=1e-12)


def test_capture_raises_for_an_empty_recording():
    empty = DepthRecording(CAMERA, 3, 30.0, lambda _: np.zeros((120, 160), np.float32))
    for body in (BODY, None):
        with pytest.raises(InvalidMotionError, match=r"No person (is|was) detected"):
            capture(empty, body)


def test_capture_reports_progress_and_can_be_cancelled(cancel):
    fractions = []
    settings = CaptureSettings(backward=False)
    capture(recorded(waving(3)), BODY, settings=settings,
            progress=lambda f, _="": fractions.append(f))  # fmt: skip
    assert fractions == sorted(fractions)
    assert_allclose(fractions[-1], 1.0)

    with pytest.raises(SolveCancelled):
        capture(recorded(waving(2)), BODY, progress=cancel)


def test_skeleton_has_a_t_pose():
    skeleton = body_skeleton(BODY)
    rest = dict(zip(skeleton.names, skeleton.rest_positions, strict=True))

    assert_allclose(rest["leftHand"][1:], rest["leftUpperArm"][1:], atol=1e-9)
    assert rest["leftHand"][0] > 0.5 > -0.5 > rest["rightHand"][0]
    assert rest["leftToes"][1] < rest["leftFoot"][1]
    assert -1e-12 <= rest["leftToes"][2] < 0.06
    assert find_humanoid_map(skeleton).score > 0.9


def test_floor_levels_a_tilted_camera():
    """The camera looks down by 20 degrees from 1.5 m; an upright actor stays upright."""
    tilt = np.radians(20.0)
    up = np.array([0.0, -np.cos(tilt), -np.sin(tilt)])
    floor = FloorPlane(up, 1.5)
    pose = posed(pitch=tilt)

    motion = body_motion(BODY, pose[np.newaxis], 30.0, floor)

    world = dict(zip(JOINTS, forward_kinematics(motion).positions[0], strict=True))
    assert_allclose((world["neck"] - world["hips"])[0], 0.0, atol=1e-9)
    trunk = world["neck"] - world["hips"]
    assert trunk[2] / np.linalg.norm(trunk) > 0.98
    heights = floor.heights(joint_positions(BODY, segment_frames(BODY, pose)))
    assert_allclose(forward_kinematics(motion).positions[0, :, 2], heights, atol=1e-9)


def test_smooth_take_is_linear_without_observations(rng):
    """Two fixed frames without observations between them: second differences are zero on a
    line.
    """
    start, stop = rng.normal(size=(2, 36))
    poses = rng.normal(size=(9, 36))
    poses[0], poses[-1] = start, stop
    nothing = (np.zeros((36, 36)), np.zeros(36))
    certain = (1e6 * np.eye(36), np.zeros(36))

    smooth = smooth_take(poses, [certain, *[nothing] * 7, certain], np.full(36, 1e3))

    fractions = np.linspace(0.0, 1.0, 9)[:, np.newaxis]
    assert_allclose(smooth, (1.0 - fractions) * start + fractions * stop, atol=1e-4)


def test_smoothing_solves_the_dense_system(rng):
    poses = rng.normal(size=(6, 36))
    equations = []
    for _ in range(6):
        root = rng.normal(size=(36, 36))
        equations.append((root @ root.T, rng.normal(size=36)))
    stiffness = rng.uniform(1.0, 5.0, size=36)

    smooth = smooth_take(poses, equations, stiffness)

    second = np.kron(np.diff(np.eye(6), 2, axis=0), np.diag(np.sqrt(stiffness)))
    dense = second.T @ second + 1e-6 * np.eye(6 * 36)
    expected = 1e-6 * poses.ravel()
    for frame, (matrix, vector) in enumerate(equations):
        index = slice(36 * frame, 36 * (frame + 1))
        dense[index, index] += matrix
        expected[index] += matrix @ poses[frame] + vector
    assert_allclose(smooth.ravel(), np.linalg.solve(dense, expected), atol=1e-8)


def test_choose_poses_rejects_a_brief_swap_with_a_higher_score():
    """Candidate 1 jumps for three frames; its joints would have to jump twice."""
    joints = np.zeros((10, 2, 4, 3))
    joints[4:7, 1] += 0.3
    scores = np.full((10, 2), 0.7)
    scores[:, 1] = 0.65
    scores[4:7, 1] = 0.72
    assert_array_equal(choose_poses(scores, joints, 0.25), np.zeros(10))

    scores[4:, 1] = 0.95
    joints[4:, 1] = 0.3
    assert_array_equal(choose_poses(scores, joints, 0.7)[5:], np.ones(5))


@given(
    tracked_frames=st.lists(st.integers(0, 30), min_size=1, unique=True).map(sorted),
    n_frames=st.integers(1, 40),
)
def test_nearest_tracked_matches_a_brute_force_search(tracked_frames, n_frames):
    found = nearest_tracked(np.array(tracked_frames), n_frames)

    slowly = [
        min(tracked_frames, key=lambda one: (abs(one - frame), one))
        for frame in range(n_frames)
    ]
    assert_array_equal(found, slowly)


def test_nearest_tracked_handles_an_hour_of_frames():
    tracked_frames = np.arange(0, 108_000, 2)
    tracemalloc.start()
    found = nearest_tracked(tracked_frames, 108_000)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()

    assert_array_equal(found[:-1], np.arange(107_999) // 2 * 2)
    assert peak < 20e6


def test_choose_poses_never_chooses_a_missing_candidate():
    scores = np.full((5, 2), 0.5)
    scores[2, 0] = np.nan
    assert choose_poses(scores, np.zeros((5, 2, 3, 3)), 0.25)[2] == 1


def test_capture_has_high_confidence_for_a_visible_static_pose():
    found = capture(recorded(np.tile(NATURAL, (4, 1))), BODY)
    assert not found.low_confidence[:, JOINTS.index("leftLowerArm")].any()
