"""From raw depth to motion where the recording is not as one would wish."""

import re
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from drawn_bodies import CAMERA, drawn, recorded, waving

from solvers.depth_scene.camera import Camera
from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.model import BodyModel, default_body
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.capturing.capture import CaptureSettings
from solvers.errors import InvalidMotionError
from solvers.recordings import read_depth
from solvers.workflows import capture_recording
from solvers.workflows.depth_capture.capture_remarks import relative_thickness

BODY = default_body()
FAST = CaptureSettings(backward=False, refine=False, check_every=1000)
LEVEL = "No floor is visible, so the camera is assumed to be level."
N_FRAMES = 12
LEGS = [
    JOINTS.index(f"{side}{bone}") for side in ("left", "right") for bone in ("Foot", "Toes")
]
ARMS = [
    JOINTS.index(f"{side}{bone}") for side in ("left", "right") for bone in ("Hand", "UpperArm")
]


def off(found, poses) -> np.ndarray:
    truth = joint_positions(BODY, segment_frames(BODY, poses))
    return np.linalg.norm(found.captured.joints.positions - truth, axis=-1)


def changed(recording: DepthRecording, change) -> DepthRecording:
    return replace(recording, read_depth=lambda one: change(one, recording.frame(one)))


def caught(recording: DepthRecording, body: BodyModel | None = BODY):
    return capture_recording(recording, body, settings=FAST, planting=None)


def test_valid_recording_has_no_remarks():
    poses = waving(N_FRAMES)

    found = caught(recorded(poses), None)

    assert found.remarks == (LEVEL,)
    assert off(found, poses).mean() < 0.04


def test_larger_of_two_people_is_tracked_and_the_other_reported():
    poses = waving(N_FRAMES)
    poses[:, 0] -= 0.6
    other = poses[0].copy()
    other[:3] += (1.3, 0.0, 0.9)
    behind = drawn(other, BODY.scaled(0.8)).astype(np.float32)

    found = caught(
        changed(recorded(poses), lambda _, depth: np.where(depth > 0.0, depth, behind))
    )

    assert "Up to 2 people are visible, from 0.0 s on; the most visible one" in found.remarks[0]
    assert off(found, poses).mean() < 0.04


def test_actor_outside_the_image_is_estimated_flagged_and_reported():
    poses = waving(30)
    poses[:, 0] += np.linspace(0.0, 3.2, 30)

    found = caught(recorded(poses))

    is_missing = np.array([not depth.any() for depth in map(drawn, poses)])
    assert 3 < is_missing.sum() < 20
    assert (
        found.captured.low_confidence[is_missing].all()
        and found.captured.low_confidence[:8].mean() < 0.1
    )
    assert re.match(
        r"No person is visible in 1\d of 30 frames, from 0\.\d s on\.", found.remarks[0]
    )
    assert off(found, poses)[:8].mean() < 0.04
    assert np.isfinite(found.motion.root_positions).all()


def test_upper_body_has_tracked_arms_and_unreliable_legs():
    poses = waving(N_FRAMES)
    shown = replace(CAMERA, height=72)
    recording = replace(
        recorded(poses), camera=shown, read_depth=lambda one: drawn(poses[one])[:72]
    )

    found = caught(recording)

    assert "The image ends above the feet: legs are estimated or omitted." in found.remarks
    assert found.captured.low_confidence[:, LEGS].all()
    assert off(found, poses)[:, ARMS].mean() < 0.05
    assert not found.captured.low_confidence[:, ARMS].any()


def test_real_upper_bodies_near_the_camera_are_captured(recordings):
    for path in sorted((recordings / "depth" / "skeltrack").iterdir())[:3]:
        found = caught(read_depth(path), None)

        assert any("ends above the feet" in remark for remark in found.remarks)
        assert found.captured.low_confidence[0, LEGS].all()
        assert found.captured.residual[0] < 0.05


def test_depth_images_with_holes_are_captured():
    """Each frame loses every sixth of its pixels, and two patches of eight by eight."""
    poses = waving(N_FRAMES)

    def torn(frame, depth):
        draw = np.random.default_rng(frame)
        depth = depth * (draw.random(depth.shape) > 0.16)
        for row, column in draw.integers([20, 60], [90, 100], (2, 2)):
            depth[row : row + 8, column : column + 8] = 0.0
        return depth

    found = caught(changed(recorded(poses), torn))

    assert found.remarks == (LEVEL,)
    assert off(found, poses).mean() < 0.04


def test_missing_frames_are_interpolated_and_reported():
    poses, missing = waving(18), (4, 5, 9, 10, 11, 15)

    found = caught(changed(recorded(poses), lambda one, depth: depth * (one not in missing)))

    assert any(
        "frames no person is detected" in message or "Nobody is" in message
        for message in found.remarks
    )
    assert found.captured.low_confidence[list(missing)].all()
    assert off(found, poses).mean() < 0.04


@pytest.mark.parametrize(
    ("across", "down", "words"),
    [
        (0.5, 0.5, "Check the focal length"), (2.0, 2.0, "check that the focal length"),
        (1.3, 1.0, "check fx and fy"), (1.0, 0.75, "check fx and fy"),
    ],
)  # fmt: skip
def test_wrong_focal_lengths_are_reported(across, down, words):
    wrong = replace(CAMERA, fx=across * CAMERA.fx, fy=down * CAMERA.fy)

    found = caught(replace(recorded(waving(3)), camera=wrong), None)

    assert any(words in remark for remark in found.remarks)


def test_very_thick_body_is_reported_as_a_possible_wrong_focal_length():
    """At half the focal length all is twice as wide and high, but no deeper."""
    barrel = BodyModel(BODY.lengths, 1.7 * BODY.radii)
    recording = recorded(waving(4), barrel)

    found = capture_recording(
        recording, settings=CaptureSettings(backward=False), planting=None
    )

    assert relative_thickness(found.captured) > 1.3
    assert any(
        "times as thick as the default body. Check the focal" in message
        for message in found.remarks
    )


def test_wrong_scale_is_refused_or_reported():
    in_millimeters = changed(recorded(waving(3)), lambda _, depth: 1000.0 * depth)

    try:
        message = " ".join(caught(in_millimeters).remarks)
    except InvalidMotionError as error:
        message = str(error)
    assert "scale" in message or "depth is in meters" in message


def test_object_that_is_no_actor_has_low_agreement():
    """A board as large as a person, a meter and a half by one."""
    board = np.zeros((120, 160), np.float32)
    board[20:110, 50:110] = 2.5
    recording = DepthRecording(
        Camera(142.8, 142.8, 79.5, 59.5, 160, 120), 3, 30.0, lambda _: board
    )

    found = caught(recording, None)

    assert any("Body and depth images match poorly" in message for message in found.remarks)


def peak_of(n_frames: int, read) -> int:
    tracemalloc.start()
    try:
        caught(DepthRecording(CAMERA, n_frames, 30.0, read))
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_images_are_released_from_memory():
    """Each further frame takes much less than its picture: a take of any length fits."""
    still = drawn(waving(1)[0]).astype(np.float32)
    peak_of(2, lambda _: still)  # What is loaded once and for all.

    few, many = (peak_of(n_frames, lambda _: still) for n_frames in (6, 36))

    assert (many - few) / 30 < 0.6 * still.nbytes
