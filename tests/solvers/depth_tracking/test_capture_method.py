"""Published methods of Track: what they track with, and when the detector runs."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_bodies import CAMERA, recorded, waving
from numpy.testing import assert_allclose

from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.motion_prior import motion_prior_from_poses
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.capturing.capture import CaptureSettings, capture
from solvers.depth_tracking.capturing.capture_method import CaptureMethod, published_system
from solvers.depth_tracking.capturing.passes import TrackingContext, track_with_restarts
from solvers.depth_tracking.capturing.restart_policies import RestartsAfterFailures
from solvers.depth_tracking.forest.pixel_forest import load_pixel_forest
from solvers.depth_tracking.published.edge_tracker import EDGE_TRACKER, EdgeLikelihood
from solvers.depth_tracking.published.registration_tracker import REGISTRATION_TRACKER
from solvers.depth_tracking.terms.tracker_settings import DEFAULT_TRACKER
from solvers.depth_tracking.tracking.failure_test import FailureTest
from solvers.depth_tracking.tracking.fit_quality import FitQuality
from solvers.depth_tracking.tracking.track_pose import all_terms, track_pose
from solvers.progress import unwatched

BODY = default_body()
TRACKERS = {
    CaptureMethod.REGISTRATION: REGISTRATION_TRACKER,
    CaptureMethod.EDGES: EDGE_TRACKER,
}
GOOD = FitQuality(0.01, 0.95, 0.9, 0.02, 0.0, 0.02, np.ones(21))
BAD = FitQuality(0.05, 0.5, 0.2, 0.4, 0.3, 0.4, np.ones(21))


def errors(found, truth):
    joints = joint_positions(BODY, segment_frames(BODY, truth))
    return np.linalg.norm(found.joints.positions - joints, axis=-1)


@pytest.mark.parametrize("method", TRACKERS)
def test_published_capture_is_its_tracker_from_the_detected_pose(method):
    """Forward, without smoothing: the second frame is that of `track_pose` from the first."""
    depth = recorded(waving(6))

    found = capture(depth, BODY, settings=CaptureSettings(method=method))

    rest = replace(depth, n_frames=5, read_depth=lambda frame: depth.frame(frame + 1))
    terms = all_terms if method is CaptureMethod.REGISTRATION else EdgeLikelihood(rest)
    expected = track_pose(
        rest, BODY, found.poses[0], settings=TRACKERS[method], likelihood=terms
    )
    assert_allclose(found.poses[1], expected.poses[0], atol=1e-9)
    assert found.restarts == ()
    assert errors(found, waving(6)).mean() < 0.04


@pytest.mark.parametrize("method", TRACKERS)
def test_confidence_of_visible_joints_does_not_depend_on_the_published_weights(method):
    """They are a thousandth of ours, which says nothing about the accuracy of a joint."""
    depth = recorded(waving(4))

    published = capture(depth, BODY, settings=CaptureSettings(method=method))
    default = capture(depth, BODY)

    assert_allclose(
        published.joints.confidence.mean(), default.joints.confidence.mean(), atol=0.1
    )


def test_detector_runs_in_frames_that_fail_and_not_at_intervals():
    settings = CaptureSettings(check_every=1, patience=1000, gain=1.0)
    recovering = RestartsAfterFailures(settings, recovers=True)
    once = RestartsAfterFailures(settings, recovers=False)

    assert [recovering.should_detect(each) for each in (None, GOOD, BAD, BAD, GOOD)] == [
        True, False, True, True, False,
    ]  # fmt: skip
    assert [once.should_detect(each) for each in (None, GOOD, BAD, BAD)] == [True, *3 * [False]]
    assert recovering.accepts(0.1, 0.9)
    strict = replace(settings, failure_test=FailureTest.PUBLISHED)
    covered = GOOD._replace(coverage=0.89)
    assert not recovering.should_detect(covered)
    assert RestartsAfterFailures(strict, recovers=True).should_detect(covered)


def test_wei_is_restarted_by_the_detector_and_lou_is_not():
    """The actor jumps by half a meter between two frames: no tracker can follow."""
    truth = waving(8)
    truth[4:, 0] += 0.5
    restarts = {}
    for method in TRACKERS:
        found = capture(recorded(truth), BODY, settings=CaptureSettings(method=method))
        restarts[method] = found.restarts
        is_right = errors(found, truth)[4:].mean() < 0.06
        assert is_right == (method is CaptureMethod.REGISTRATION)
    assert 4 in restarts[CaptureMethod.REGISTRATION]
    assert restarts[CaptureMethod.EDGES] == ()


def test_motion_prior_is_part_of_lou_only():
    depth, prior = recorded(waving(3)), motion_prior_from_poses([waving(60)])
    for method in TRACKERS:
        plain, drawn = (
            capture(depth, BODY, motion_prior=given, settings=CaptureSettings(method=method))
            for given in (None, prior)
        )
        same = np.allclose(plain.poses, drawn.poses, atol=1e-9)
        assert same == (method is CaptureMethod.REGISTRATION)


def test_colors_reach_the_term_of_lou():
    """A pass reads each color image once, although two frames need it."""
    truth, read = waving(5), []

    def read_color(frame):
        read.append(frame)
        return np.full((CAMERA.height, CAMERA.width, 3), 100, dtype=np.uint8)

    depth = replace(recorded(truth), read_color=read_color)
    actor = TrackingContext(
        depth, BODY, load_pixel_forest(), DEFAULT_TRACKER, CaptureSettings()
    )
    actor, policy = published_system(actor, CaptureMethod.EDGES)
    track_with_restarts(actor, range(5), truth[0], unwatched, policy)

    assert read == [0, 1, 2, 3, 4]


def test_frames_without_an_actor_are_bridged():
    truth = waving(6)
    recording = recorded(truth)

    def read_depth(frame):
        return np.zeros((120, 160), np.float32) if frame == 3 else recording.frame(frame)

    depth = DepthRecording(CAMERA, 6, 30.0, read_depth)
    for method in TRACKERS:
        found = capture(depth, BODY, settings=CaptureSettings(method=method))
        assert np.isnan(found.residual[3]) and np.isfinite(found.poses).all()
        assert errors(found, truth)[[4, 5]].mean() < 0.06
