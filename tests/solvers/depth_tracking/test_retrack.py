"""Adjacent frames follow the correction of one frame; other frames stay unchanged."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from drawn_bodies import recorded, waving
from numpy.testing import assert_allclose, assert_array_equal

from solvers.depth_scene.floor import FloorPlane
from solvers.depth_tracking.body.coordinates import COORDINATES
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.motion import body_motion, motion_frames
from solvers.depth_tracking.body.pose_from_joints import pose_from_frames
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.capturing import retracked_path
from solvers.depth_tracking.capturing.passes import TrackingContext
from solvers.depth_tracking.capturing.restart_policies import RecoverySettings
from solvers.depth_tracking.capturing.retrack import RetrackSettings, retrack
from solvers.depth_tracking.terms import TrackerSettings
from solvers.depth_tracking.tracking.fit_quality import FitQuality
from solvers.errors import InvalidMotionError, SolveCancelled
from solvers.progress import unwatched
from solvers.rotations.representations import (
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
)

BODY = default_body()
FLOOR = FloorPlane(np.array([0.1, -0.99, -0.1]) / np.linalg.norm([0.1, -0.99, -0.1]), 0.9)
N_FRAMES, CORRECTED, WRONG = 40, 20, slice(10, 30)
ARM = [JOINTS.index(name) for name in ("rightLowerArm", "rightHand")]


def with_error(poses):
    """The right forearm points up for some frames, where it is invisible."""
    wrong = poses.copy()
    wrong[WRONG, COORDINATES.index("rightHumerusZ")] += 1.6
    wrong[CORRECTED] = poses[CORRECTED]
    return wrong


def joints_of(motion, floor=FLOOR):
    frames = motion_frames(BODY, motion, floor)
    return joint_positions(BODY, frames)


@pytest.fixture(scope="module")
def take():
    truth = waving(N_FRAMES)
    return recorded(truth), truth, body_motion(BODY, with_error(truth), 30.0, FLOOR)


@pytest.fixture(scope="module")
def retracked(take):
    depth, _, motion = take
    return retrack(depth, BODY, motion, CORRECTED, floor=FLOOR)


def test_motion_frames_invert_body_motion():
    poses = waving(9)
    motion = body_motion(BODY, poses, 30.0, FLOOR)
    assert_allclose(motion_frames(BODY, motion, FLOOR), segment_frames(BODY, poses), atol=1e-9)


def test_pose_from_frames_needs_no_initial_pose():
    for pose in waving(40)[::13]:
        frames = segment_frames(BODY, pose)
        again = segment_frames(BODY, pose_from_frames(BODY, frames))
        assert_allclose(again[:, :3, 3], frames[:, :3, 3], atol=2e-3)
        assert_allclose(again[:, :3, :3], frames[:, :3, :3], atol=0.02)


def test_motions_do_not_agree_where_an_occluded_arm_differs():
    """Nothing of the body is visible, so its joints have confidence 0."""
    truth = waving(N_FRAMES)
    actor = SimpleNamespace(body=BODY)
    occluded = FitQuality(*np.zeros(6), np.zeros(len(JOINTS)))
    frame = CORRECTED + 1

    distance = retracked_path._largest_distance(
        actor, truth[frame], with_error(truth)[frame], occluded
    )

    assert distance > RetrackSettings().agreement


@pytest.mark.parametrize(("loss", "n_poses"), [(0.01, 8), (0.02, 4)])
def test_path_may_fit_a_little_worse_than_the_old_motion(monkeypatch, loss, n_poses):
    """It never rejoins the old motion, and its score is lower by this in every frame."""
    truth = waving(N_FRAMES)
    score = FitQuality(*np.zeros(6), np.ones(len(JOINTS)))._replace(score=0.8)
    worse = score._replace(score=0.8 - loss)
    for name, result in (
        ("observe", None),
        ("next_pose_prior", None),
        ("track_frame", (truth[CORRECTED], worse)),
        ("measure_fit", score),
    ):
        monkeypatch.setattr(retracked_path, name, lambda *given, result=result: result)
    settings = TrackerSettings(), RecoverySettings()
    actor = TrackingContext(recorded(truth), BODY, None, *settings)

    path = retracked_path.track_from_correction(
        actor, truth[CORRECTED], range(8), lambda frame: truth[CORRECTED] + 1.0,
        RetrackSettings(blend=0.1), unwatched,
    )  # fmt: skip

    assert len(path.poses) == n_poses


def test_retrack_corrects_the_error_and_keeps_other_frames(take, retracked):
    _, truth, motion = take
    right = joint_positions(BODY, segment_frames(BODY, truth))

    before = np.linalg.norm(joints_of(motion) - right, axis=-1)[WRONG][:, ARM]
    after = np.linalg.norm(joints_of(retracked.motion) - right, axis=-1)

    assert before.mean() > 0.3
    assert after[WRONG][:, ARM].mean() < 0.02
    assert after.max() < 0.08
    assert retracked.met == (True, True)
    assert 0 <= retracked.first <= 4 and 35 <= retracked.last <= 39
    outside = [*range(retracked.first), CORRECTED, *range(retracked.last + 1, N_FRAMES)]
    assert_array_equal(retracked.motion.rotations[outside], motion.rotations[outside])
    assert_array_equal(retracked.motion.root_positions[outside], motion.root_positions[outside])
    assert (
        len(retracked.residual)
        == retracked.last - retracked.first + 1
        == retracked.joints.n_frames
    )


def test_retrack_is_continuous_at_the_joins(take, retracked):
    _, truth, _ = take
    right = joint_positions(BODY, segment_frames(BODY, truth))
    step = np.linalg.norm(np.diff(joints_of(retracked.motion), axis=0), axis=-1).max()
    assert step < np.linalg.norm(np.diff(right, axis=0), axis=-1).max() + 0.02


def test_retrack_fades_out_unreachable_rotations(take):
    """Images and coordinates do not determine the forearm's axial rotation that was edited."""
    depth, truth, _ = take
    motion = body_motion(BODY, truth, 30.0, FLOOR)
    rotations = motion.rotations.copy()
    elbow, twist = JOINTS.index("leftLowerArm"), np.array([0.8, 0.0, 0.0])
    rotation = quaternion_from_rotation_vector(twist)
    rotations[CORRECTED, elbow] = multiply(rotations[CORRECTED, elbow], rotation)
    twisted = replace(motion, rotations=rotations)

    retracked = retrack(depth, BODY, twisted, CORRECTED, floor=FLOOR).motion

    assert_array_equal(retracked.rotations[CORRECTED], rotations[CORRECTED])
    angles = angle_between(retracked.rotations[:, elbow], motion.rotations[:, elbow])
    assert angles[CORRECTED] == pytest.approx(0.8)
    assert 0.6 < angles[CORRECTED + 1] < 0.8 and 0.6 < angles[CORRECTED - 1] < 0.8
    assert 0.1 < angles[CORRECTED + 5] < 0.6 and angles[CORRECTED + 9] < 0.05
    joints = joints_of(motion)
    assert np.linalg.norm(joints_of(retracked) - joints, axis=-1).max() < 0.03


def test_reach_and_fixed_frames_end_the_segment(take):
    depth, _, motion = take
    short = retrack(depth, BODY, motion, CORRECTED, floor=FLOOR, fixed=[3, 23],
                    settings=RetrackSettings(reach=0.1))  # fmt: skip
    assert (short.first, short.last) == (17, 22)
    assert short.met == (False, False)
    separate = retrack(depth, BODY, motion, CORRECTED, floor=FLOOR,
                    settings=RetrackSettings(reach=0.0))  # fmt: skip
    assert (separate.first, separate.last) == (CORRECTED, CORRECTED)
    assert_array_equal(separate.motion.rotations, motion.rotations)


def test_first_frame_can_be_corrected(take):
    depth, truth, _ = take
    wrong = truth.copy()
    wrong[1:12, COORDINATES.index("rightHumerusZ")] += 1.6
    retracked = retrack(depth, BODY, body_motion(BODY, wrong, 30.0), 0)

    right = joint_positions(BODY, segment_frames(BODY, truth))
    after = np.linalg.norm(joints_of(retracked.motion, None) - right, axis=-1)
    assert retracked.first == 0 and after[:, ARM].max() < 0.08


def test_retrack_previews_poses_and_can_be_cancelled(take, cancel):
    depth, _, motion = take
    observed, fractions = [], []
    retracked = retrack(depth, BODY, motion, CORRECTED, floor=FLOOR, on_pose=observed.append,
                    progress=lambda fraction, _="": fractions.append(fraction))  # fmt: skip
    last = len(retracked.residual)
    assert [one.frame for one in observed[-last:]] == list(
        range(retracked.first, retracked.last + 1)
    )
    assert fractions == sorted(fractions) and fractions[-1] == pytest.approx(1.0)

    with pytest.raises(SolveCancelled):
        retrack(depth, BODY, motion, CORRECTED, progress=cancel)


def test_retrack_raises_for_mismatched_inputs(take):
    depth, truth, motion = take
    with pytest.raises(InvalidMotionError, match="no frame 40"):
        retrack(depth, BODY, motion, 40)
    with pytest.raises(InvalidMotionError, match="has 39 frames"):
        retrack(depth, BODY, body_motion(BODY, truth[:39], 30.0), 3)
    gaps = motion.rotations.copy()
    gaps[5] = np.nan
    with pytest.raises(InvalidMotionError, match="gaps"):
        retrack(depth, BODY, replace(motion, rotations=gaps), 3)
