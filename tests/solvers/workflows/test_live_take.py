"""A stream of joints becomes poses of a skeleton, at the times of its frames."""

from dataclasses import replace

import kinect_walks
import numpy as np
import pytest

from solvers import motion, samples
from solvers.motion import forward_kinematics
from solvers.motion.humanoid import posture_joints
from solvers.recordings.streams import frames_from_recording
from solvers.workflows import LiveTake, LiveTakeSettings
from solvers.workflows.live.first_frames import MAX_FIRST_FRAMES

SHORT = LiveTakeSettings(calibration_s=1.0)


@pytest.fixture(scope="module")
def frames():
    true = kinect_walks.true_positions(samples, posture_joints)
    return list(frames_from_recording(kinect_walks.tracked_walk(motion, true)))


@pytest.fixture
def started(frames):
    take = LiveTake(SHORT)
    for frame in frames[:31]:
        assert take.add([frame]) == []
    assert take.calibration is not None
    return take


def test_first_seconds_measure_the_actor(frames):
    take = LiveTake(SHORT)
    take.add(frames[:16])
    assert take.calibration is None
    assert take.calibrated_fraction == pytest.approx(0.5, abs=0.01)
    take.add(frames[16:31])
    assert take.calibrated_fraction == 1.0
    assert take.calibration.frame_rate == pytest.approx(30.0, abs=0.1)


def test_poses_have_the_reconstructed_joints(started, frames):
    poses = [pose for frame in frames[31:41] for pose in started.add([frame])]
    assert [each.frame for each in poses] == list(range(1, 11))
    names = list(started.names)
    hips, knee = names.index("HipCenter"), names.index("KneeLeft")
    for pose in poses:
        joints = dict(zip(
            pose.motion.skeleton.names, forward_kinematics(pose.motion).positions[0],
            strict=True,
        ))  # fmt: skip
        assert np.allclose(joints["HipCenter"], pose.joints.positions[hips], atol=1e-9)
        assert np.linalg.norm(joints["KneeLeft"] - pose.joints.positions[knee]) < 0.05


def test_frames_that_were_dropped_leave_their_time(started, frames):
    poses = started.add([frames[31]]) + started.add([frames[36]])
    assert [each.frame for each in poses] == [1, 6]


def test_a_sender_that_starts_again_goes_on(started, frames):
    poses = started.add([frames[31]]) + started.add([frames[0]]) + started.add([frames[1]])
    assert [each.frame for each in poses] == [1, 2, 3]


def test_frames_that_wait_too_long_are_skipped(started, frames):
    poses = started.add(frames[31:41])
    assert started.n_skipped == 8
    assert [each.frame for each in poses] == [9, 10]


def test_frames_of_other_joints_are_ignored(started, frames):
    assert started.add([replace(frames[31], names=tuple(map(str, range(20))))]) == []


def test_frames_of_a_clock_that_hardly_moves_are_bounded(frames):
    take, step = LiveTake(SHORT), 1e-6
    many = [replace(frames[0], time=step * number) for number in range(2 * MAX_FIRST_FRAMES)]
    take.add(many[:MAX_FIRST_FRAMES])
    take.add(many[MAX_FIRST_FRAMES:])

    assert take.calibrated_fraction == pytest.approx(step * (MAX_FIRST_FRAMES - 1))


@pytest.mark.parametrize("change", [{"body": 7}, {"time": 5.0}])
def test_measuring_starts_again_after_a_gap_and_with_another_actor(frames, change):
    take = LiveTake(SHORT)
    take.add(frames[:20])
    take.add([replace(frames[20], **change)])
    assert take.calibrated_fraction == 0.0


def test_another_actor_begins_with_fresh_filters(started, frames):
    far = [replace(each, body=7, positions=each.positions + 3.0) for each in frames[31:33]]
    poses = started.add(far[:1])
    names = list(started.names)
    hips = poses[0].joints.positions[names.index("HipCenter")]
    assert np.linalg.norm(hips - far[0].positions[names.index("HipCenter")]) < 0.1
    assert poses[0].body == 7
