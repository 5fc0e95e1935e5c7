"""The tracker finds and follows the pose of rendered depth images."""

import numpy as np
import pytest
from drawn_bodies import CAMERA, NATURAL, observed, recorded, waving
from numpy.testing import assert_allclose, assert_array_equal

from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.coordinates import COORDINATES, LOWER_LIMITS, UPPER_LIMITS
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.pose_priors import (
    joint_limits,
    natural_stance,
    predict_pose,
    stay_near,
)
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.published.registration_tracker import REGISTRATION_TRACKER
from solvers.depth_tracking.terms.tracker_settings import DEFAULT_TRACKER, TrackerSettings
from solvers.depth_tracking.tracking.register_pose import register_pose
from solvers.depth_tracking.tracking.track_pose import track_pose
from solvers.errors import InvalidMotionError, SolveCancelled

BODY = default_body()


def joints_of(poses, body=BODY):
    return joint_positions(body, segment_frames(body, poses))


def mean_error(poses, truth):
    return np.linalg.norm(joints_of(poses) - joints_of(truth), axis=-1).mean()


def no_prior(pose):
    return stay_near(pose, pose, np.zeros(36))


def test_tracker_converges_from_a_wide_basin(rng):
    """From errors of 3 cm and 6 degrees per joint, nearly always to less than 1 cm."""
    errors, before = [], []
    for _ in range(12):
        start = NATURAL + rng.normal(scale=0.1, size=36)
        start[:3] = NATURAL[:3] + rng.normal(scale=0.02, size=3)
        found = register_pose(
            BODY, start, observed(NATURAL), no_prior, TrackerSettings(iterations=25)
        )
        before.append(mean_error(start, NATURAL))
        errors.append(mean_error(found.pose, NATURAL))
    assert np.mean(before) > 0.05
    assert np.median(errors) < 0.01
    assert np.mean(np.array(errors) < 0.03) >= 0.75


def test_cost_decreases_if_only_improvements_are_accepted(rng):
    start = NATURAL + rng.normal(scale=0.1, size=36)
    costs = [
        register_pose(
            BODY, start, observed(NATURAL), no_prior,
            TrackerSettings(iterations=n, coarse_iterations=0),
        ).equations.cost
        for n in (1, 3, 6, 12)
    ]  # fmt: skip
    assert costs == sorted(costs, reverse=True)
    assert costs[-1] < 0.2 * costs[0]


@pytest.mark.parametrize(
    ("settings", "worst"), [(DEFAULT_TRACKER, 0.02), (REGISTRATION_TRACKER, 0.08)]
)
def test_track_pose_follows_a_waving_actor(settings, worst):
    truth = waving(30)

    tracked = track_pose(recorded(truth), BODY, truth[0], settings=settings)

    assert mean_error(tracked.poses, truth) < worst
    assert tracked.joints.names == JOINTS
    assert_allclose(tracked.joints.positions, joints_of(tracked.poses))
    assert tracked.residual.max() < 0.03
    assert tracked.coverage.min() > 0.7


def test_constant_pose_has_a_larger_error():
    truth = waving(30)
    assert mean_error(np.tile(truth[0], (30, 1)), truth) > 0.1


def test_track_pose_repeats_exactly():
    truth = waving(5)
    first, second = (track_pose(recorded(truth), BODY, truth[0]) for _ in range(2))
    assert_array_equal(first.poses, second.poses)


def test_result_scales_with_the_actor_and_the_distance():
    """Twice the distance and twice the size give the same rays."""
    truth = waving(6)
    doubled = truth.copy()
    doubled[:, :3] *= 2.0

    near_result = track_pose(recorded(truth), BODY, truth[0])
    far_result = track_pose(recorded(doubled, BODY.scaled(2.0)), BODY.scaled(2.0), doubled[0])

    assert_allclose(far_result.poses[:, 3:], near_result.poses[:, 3:], atol=0.12)


def test_confidence_is_low_for_an_occluded_limb():
    """The left arm behind the back has a higher confidence from behind than from the front."""
    front = waving(3) * 0.0 + NATURAL
    behind = front.copy()
    for pose in (front, behind):
        pose[:, 3] = 0.0
        pose[:, 16] = -0.7  # left humerus back
        pose[:, 18] = -0.3
        pose[:, 19] = 1.2
    behind[:, 3] = np.pi
    hand = JOINTS.index("leftHand")

    from_front, from_behind = (
        track_pose(recorded(poses), BODY, poses[0]).joints.confidence[-1, hand]
        for poses in (front, behind)
    )

    assert from_front < 0.7 * from_behind


def test_track_pose_bridges_an_empty_frame_with_zero_confidence():
    truth = waving(6)
    recording = recorded(truth)

    def read(frame):
        return np.zeros((120, 160), dtype=np.float32) if frame == 3 else recording.frame(frame)

    holed = DepthRecording(CAMERA, 6, 30.0, read)
    tracked = track_pose(holed, BODY, truth[0])

    assert np.isnan(tracked.residual[3]) and tracked.coverage[3] == 0.0
    assert_array_equal(tracked.joints.confidence[3], 0.0)
    assert mean_error(tracked.poses, truth) < 0.03


def test_track_pose_reports_progress_and_can_be_cancelled(cancel):
    fractions = []
    track_pose(recorded(waving(3)), BODY, NATURAL, progress=lambda f, _="": fractions.append(f))
    assert_allclose(fractions, [1 / 3, 2 / 3, 1.0])

    with pytest.raises(SolveCancelled):
        track_pose(recorded(waving(3)), BODY, NATURAL, progress=cancel)


@pytest.mark.parametrize("pose", [np.zeros(33), np.full(36, np.nan)])
def test_track_pose_raises_for_an_invalid_pose(pose):
    with pytest.raises(InvalidMotionError, match="36 finite coordinates"):
        track_pose(recorded(waving(1)), BODY, pose)


def test_joint_limits_affect_only_exceeded_coordinates():
    inside = np.clip(np.zeros(36), LOWER_LIMITS, UPPER_LIMITS) + 0.01 * np.isfinite(
        LOWER_LIMITS
    )
    assert joint_limits(inside, 1.0).cost == 0.0
    beyond = inside.copy()
    beyond[10] = UPPER_LIMITS[10] + 0.2
    requested = joint_limits(beyond, 3.0)
    assert_allclose(requested.vector, -0.6 * np.eye(36)[10], atol=1e-12)


def test_predict_pose_extrapolates_constant_velocity():
    poses = [np.full(36, 1.0), np.full(36, 1.5)]
    assert_allclose(predict_pose(poses, 1.0), 2.0)
    assert_allclose(predict_pose(poses, 0.0), 1.5)
    assert_allclose(predict_pose(poses[:1], 1.0), 1.0)


def test_observation_of_a_few_pixels_is_empty():
    truth = waving(4)
    recording = recorded(truth)

    def read(frame):
        depth = recording.frame(frame).copy()
        if frame == 2:
            depth.ravel()[np.flatnonzero(depth)[9:]] = 0.0
        return depth

    tracked = track_pose(DepthRecording(CAMERA, 4, 30.0, read), BODY, truth[0])

    assert tracked.coverage[2] == 0.0
    assert mean_error(tracked.poses, truth) < 0.03


def test_pose_without_terms_is_the_predicted_one():
    nothing = TrackerSettings(
        closest_weight=0.0, off_actor_weight=0.0, too_near_weight=0.0, depth_weight=0.0,
        extra_weight=0.0, silhouette_weight=0.0, natural_weight=0.0, limit_weight=0.0,
    )  # fmt: skip
    truth = waving(2)

    tracked = track_pose(recorded(truth), BODY, truth[0], settings=nothing)

    assert_allclose(tracked.poses, np.tile(truth[0], (2, 1)), atol=1e-9)


def test_natural_stance_weighs_the_trunk_more_than_limbs():
    equations = natural_stance(np.ones(36), 2.0, 5.0)
    assert_allclose(equations.vector[:6], 0.0)
    trunk, limb = (COORDINATES.index(name) for name in ("lowerBackZ", "leftFemurX"))
    assert equations.vector[trunk] < equations.vector[limb] < 0.0
    assert equations.vector[COORDINATES.index("rightAnkle")] == -5.0
    assert_allclose(equations.cost, 0.5 * np.trace(equations.matrix))
