"""Tracking image by image equals the forward pass of a capture, and bears a late detector."""

import numpy as np
import pytest
from drawn_bodies import CAMERA, recorded, waving
from numpy.testing import assert_allclose, assert_array_equal

from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.coordinates import COORDINATES
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.capturing.passes import TrackingContext, track_with_restarts
from solvers.depth_tracking.capturing.restart_policies import RecoverySettings
from solvers.depth_tracking.following import live_tracker
from solvers.depth_tracking.following.assemble_followed import assemble_followed
from solvers.depth_tracking.following.live_tracker import LiveTracker
from solvers.depth_tracking.following.pose_detectors import DelayedDetector, Detection
from solvers.depth_tracking.forest.pixel_forest import load_pixel_forest
from solvers.depth_tracking.terms.tracker_settings import DEFAULT_TRACKER
from solvers.errors import InvalidMotionError
from solvers.progress import unwatched

BODY = default_body()
FOREST = load_pixel_forest()
RECOVERY = RecoverySettings(check_every=6)


@pytest.fixture(scope="module")
def hidden():
    """A take without an actor in two frames, and with half of the body hidden in six."""
    recording = recorded(poses())

    def read(frame):
        image = recording.frame(frame).copy()
        if 8 <= frame < 14:
            image[:, 80:] = 0.0
        return 0.0 * image if frame in {0, 20} else image

    return DepthRecording(CAMERA, 30, 30.0, read)


def poses():
    found = waving(30)
    found[:, COORDINATES.index("rightHumerusZ")] = np.linspace(0.2, 1.4, 30)
    return found


def follow(recording, delays=(0,), detector=None, waits=True):
    """Return the tracker, and its result in each frame."""
    detector = detector or DelayedDetector(FOREST, delays)
    tracker = LiveTracker(CAMERA, 30.0, BODY, detector, recovery=RECOVERY, waits=waits)
    frames = range(recording.n_frames)
    return tracker, [tracker.update(frame, recording.frame(frame)) for frame in frames]


@pytest.fixture(scope="module")
def forward(hidden):
    context = TrackingContext(hidden, BODY, FOREST, DEFAULT_TRACKER, RECOVERY)
    return track_with_restarts(context, range(hidden.n_frames), None, unwatched)


def test_equals_the_forward_pass_frame_by_frame(hidden, forward):
    tracker, found = follow(hidden)

    assert tracker.restarts == [*forward.restarts] != []
    assert found[0] is None and np.isnan(forward.poses[0]).all()
    assert_array_equal([each.pose for each in found[1:]], forward.poses[1:])
    scores = [each.quality.score for each in found[1:]]
    is_seen = np.isfinite(forward.scores[1:])
    assert_array_equal(np.array(scores)[is_seen], forward.scores[1:][is_seen])


def test_late_detection_replaces_a_failed_pose_in_the_present_frame(hidden):
    tracker, found = follow(hidden, (5,))

    assert tracker.restarts and set(tracker.delays[1:]) == {5}
    restart = tracker.restarts[-1]
    requested, present = poses()[restart - 5], poses()[restart]
    assert distance(found[restart].pose, present) < 0.01 < distance(requested, present)
    assert distance(found[-1].pose, poses()[-1]) < 0.05


def test_tracker_that_does_not_wait_begins_in_the_present_image():
    _, found = follow(recorded(poses()[10:18]), (5,), waits=False)

    assert found[:5] == [None] * 5
    assert distance(found[5].pose, poses()[15]) < 0.01 < distance(poses()[10], poses()[15])


def distance(pose, other):
    """Return the mean distance of the joints, meters."""
    positions = [joint_positions(BODY, segment_frames(BODY, each)) for each in (pose, other)]
    return np.linalg.norm(positions[0] - positions[1], axis=-1).mean()


def test_without_a_better_detection_a_late_detector_changes_nothing():
    """Each frame depends on those before it, and not on detections that are not accepted."""
    recording = recorded(waving(12))
    runs = [follow(recording, (delay,))[1] for delay in (0, 3)]

    for here, late in zip(*runs, strict=True):
        assert_array_equal(here.pose, late.pose)


class SilentDetector:
    """Finds the first pose, and never answers again."""

    issue = ""

    def __init__(self):
        self._first = DelayedDetector(FOREST)
        self.n_requests = 0

    @property
    def is_idle(self):
        return self.n_requests < 2

    def request(self, request):
        self.n_requests += 1
        if self.n_requests == 1:
            self._first.request(request)

    def wait(self):
        return

    def poll(self):
        return self._first.poll()


def test_detector_that_never_answers_costs_neither_poses_nor_memory(monkeypatch):
    monkeypatch.setattr(live_tracker, "MAX_KEPT_FRAMES", 4)
    n_frames = 14
    pictures = [recorded(waving(1)).frame(0)] * n_frames
    recording = DepthRecording(CAMERA, n_frames, 30.0, pictures.__getitem__)
    detector = SilentDetector()

    tracker, found = follow(recording, detector=detector)

    assert detector.n_requests == 2 and all(found) and not tracker.restarts
    assert len(tracker._kept) <= 4


def test_detection_without_a_request_is_ignored():
    class Hasty(DelayedDetector):
        def poll(self):
            return super().poll() or Detection(None)

    _, found = follow(recorded(waving(3)), detector=Hasty(FOREST))

    assert all(found)


def test_frames_between_tracked_ones_are_interpolated_with_confidence_0():
    _, found = follow(recorded(waving(9)))
    kept = [each for each in found if each.frame in {2, 3, 6, 8}]

    first, capture = assemble_followed(kept, 30.0, restarts=[1, 2, 6])

    assert first == 2 and capture.motion.n_frames == 7 and capture.restarts == (4,)
    expected = found[3].pose + (found[6].pose - found[3].pose) / 3.0
    assert_allclose(capture.poses[2], expected, atol=1e-12)
    assert_array_equal(capture.poses[4], found[6].pose)
    is_tracked = capture.joints.confidence.any(axis=1)
    assert_array_equal(is_tracked, [True, True, False, False, True, False, True])
    assert capture.low_confidence[~is_tracked].all()
    assert_array_equal(np.isnan(capture.residual), ~is_tracked)


def test_motion_without_poses_is_refused():
    with pytest.raises(InvalidMotionError, match="No pose was tracked"):
        assemble_followed([], 30.0)
