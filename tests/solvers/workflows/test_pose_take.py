"""A stream of bones is taken as it is, at the times of its frames."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError
from solvers.motion import Skeleton
from solvers.recordings.streams import PoseFrame, joints_from_pose
from solvers.samples import GaitSettings, walking_gait
from solvers.workflows import LiveTakeSettings, PoseTake
from solvers.workflows.live.time_slots import TimeSlots

SHORT = LiveTakeSettings(calibration_s=1.0)


@pytest.fixture(scope="module")
def walk():
    return walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))


@pytest.fixture(scope="module")
def frames(walk):
    return [
        PoseFrame(number / 30.0, 0, walk.skeleton, rotations, position)
        for number, (rotations, position) in enumerate(
            zip(walk.rotations, walk.root_positions, strict=True)
        )
    ]


@pytest.fixture
def started(frames):
    take = PoseTake(SHORT)
    assert take.add(frames[:31]) == []
    assert take.calibration is not None
    return take


def test_poses_are_those_of_the_stream(started, frames, walk):
    poses = [pose for frame in frames[31:] for pose in started.add([frame])]

    assert [pose.frame for pose in poses] == list(range(1, 30))
    assert poses[0].joints is None and poses[0].body == 0 and poses[0].motion.frame_rate == 30.0
    assert_allclose([pose.motion.rotations[0] for pose in poses], walk.rotations[31:])
    assert_allclose([pose.motion.root_positions[0] for pose in poses], walk.root_positions[31:])


@pytest.mark.parametrize(("rate", "slots"), [(60.0, 15), (15.0, 29), (30.0, 29)])
def test_frames_keep_their_time_when_the_rate_changes(started, frames, rate, slots):
    later = [
        replace(frame, time=frames[30].time + number / rate)
        for number, frame in enumerate(frames[31:], start=1)
    ]

    poses = [pose for frame in later for pose in started.add([frame])]

    numbers = np.array([pose.frame for pose in poses])
    assert len(numbers) == slots
    assert numbers[-1] == pytest.approx(29 * 30.0 / rate, abs=1)


@pytest.mark.parametrize("change", [{"body": 7}, {"time": 9.0}, {"time": -9.0}])
def test_measuring_starts_again_with_another_body_and_after_a_gap(frames, change):
    take = PoseTake(SHORT)
    take.add(frames[:20])

    take.add([replace(frames[20], **change)])

    assert take.calibrated_fraction == 0.0


def test_other_bones_are_left_out_and_noticed(started, frames):
    names = tuple(f"{name}_" for name in frames[0].names)
    skeleton = frames[0].skeleton
    other = Skeleton(names, skeleton.parents, skeleton.offsets)

    assert started.add([replace(frames[31], skeleton=other)]) == []
    assert started.has_other_body
    assert len(started.add([frames[32]])) == 1
    assert not started.has_other_body
    assert started.add([joints_from_pose(frames[33])]) == []
    assert started.has_other_body


def test_frames_that_wait_too_long_are_skipped(started, frames):
    poses = started.add(frames[31:51])

    assert started.n_skipped == 8 and len(poses) == 12


def test_a_stream_without_legs_is_reported(frames):
    arm = Skeleton(("hips", "spine"), (-1, 0), np.eye(2, 3))
    still = [
        replace(frame, skeleton=arm, rotations=frame.rotations[:2]) for frame in frames[:40]
    ]

    with pytest.raises(InvalidMotionError, match="no bones for head, leftUpperLeg"):
        PoseTake(SHORT).add(still)


@pytest.mark.parametrize("jump", [1e4, 1e11, 1e307, -1e9])
def test_a_clock_that_jumps_goes_on_from_the_last_slot(started, frames, jump):
    later = [replace(frame, time=frame.time + jump) for frame in frames[32:34]]

    poses = [pose for frame in [frames[31], *later] for pose in started.add([frame])]

    assert [pose.frame for pose in poses[:2]] == [1, 2] and poses[-1].frame <= 3


def test_a_long_gap_keeps_its_duration():
    clock = [100.0]
    slots = TimeSlots(3.0, 30.0, now=lambda: clock[0])
    clock[0] += 60.0

    assert slots.next(63.0) == 1800
