"""JSON is read whatever its members are called, and what it lacks is reported."""

import json
import time

import numpy as np
import pytest
from exports.camera_bodies import mediapipe
from joint_files import moving

from solvers.errors import InvalidFileError
from solvers.motion import Sensor
from solvers.motion.skeletons import BODY_POINTS
from solvers.recordings.joint_files.json_bodies import is_frames_json
from solvers.recordings.point_bodies.unnamed_joints import name_joints

N = 40
POINTS = mediapipe(N)


def landmarks(k, **others):
    return [dict(zip("xyz", row, strict=True)) | others for row in POINTS[k, :, :3].tolist()]


def picture(k):
    """Return landmarks as fractions of a picture."""
    points = (0.5, 0.5, 0.0) + 0.2 * POINTS[k, :, :3]
    return [
        {"name": name, "visibility": 1, **dict(zip("xyz", row, strict=True))}
        for name, row in zip(BODY_POINTS, points.tolist(), strict=True)
    ]


@pytest.fixture(scope="module")
def walk(walker):
    return {role: path[:N] for role, path in walker.items()}


def joints(walk, k, origin=0.0, wrap=list):
    return [{"name": role, "position": wrap((path[k] - origin).tolist())}
            for role, path in walk.items()]  # fmt: skip


def test_points_in_the_world_come_before_those_in_the_picture(read_any):
    """Such a recording of a web page is none of a picture."""
    frames = [{"keypoints": picture(k), "worldKeypoints": landmarks(k)} for k in range(N)]

    recording = read_any(json.dumps({"id": "a", "frames": frames}))

    x, y, z = np.moveaxis(POINTS[..., :3], -1, 0)
    assert np.allclose(recording.tracks.positions[:, :33], np.stack([x, z, -y], axis=-1))


@pytest.mark.parametrize("key", ["lm", "poseData"])
def test_landmarks_may_have_any_key(read_any, key):
    frames = [{"t": 40 * k, key: landmarks(k, visibility=0.9)} for k in range(N)]

    recording = read_any(json.dumps({"videoId": "a", "frames": frames}))

    assert (recording.sensor, recording.frame_rate) == (Sensor.MEDIAPIPE, 25.0)


def test_landmarks_of_a_picture_with_any_key_are_refused_as_such(read_any):
    with pytest.raises(InvalidFileError, match="image landmarks, without true depth"):
        read_any(json.dumps([{"t": 40 * k, "lm": picture(k)} for k in range(N)]))


def test_bones_of_a_game_engine_may_have_any_key(read_any, walk):
    frames = [
        {"boneValues": joints(walk, k, wrap=lambda p: dict(zip("xyz", p, strict=True))),
         "worldTime": k / 50}
        for k in range(N)
    ]  # fmt: skip
    content = {"skeletonRecordings": frames, "initialTransform": {"scale3D": {"x": 1}}}

    recording = read_any(json.dumps(content))

    assert recording.frame_rate == 50.0
    assert "left_wrist" in recording.names


@pytest.mark.parametrize("header", ["metadata", "video_info"])
def test_the_rate_may_stand_in_a_header(read_any, header):
    frames = [{"landmarks": landmarks(k)} for k in range(N)]

    assert read_any(json.dumps({header: {"fps": 60}, "frames": frames})).frame_rate == 60.0


def test_frames_that_are_numbered_in_steps_have_a_part_of_the_rate(
    read_any, collected_messages
):
    """A take of which each second frame was saved plays at its speed."""
    messages, progress = collected_messages
    frames = [{"frame_index": 2 * k, "landmarks": landmarks(k)} for k in range(N)]

    recording = read_any(json.dumps({"frames": frames, "fps": 60}), progress=progress)

    assert recording.frame_rate == 30.0
    assert "Frames are numbered in steps of 2; their rate is 30 Hz" in messages


def test_numbers_that_are_milliseconds_leave_the_rate(read_any):
    frames = [{"frame": 40 * k, "landmarks": landmarks(k)} for k in range(N)]

    assert read_any(json.dumps({"frames": frames, "fps": 25})).frame_rate == 25.0


@pytest.mark.parametrize(("stated", "rate"), [({"fps": 50}, 50.0), ({}, 30.0)])
@pytest.mark.parametrize("time", [{"timestamp": 5.0}, {"header": {"stamp": 5.0}}])
def test_times_that_stand_still_are_reported_and_not_used(
    read_any, collected_messages, stated, rate, time
):
    messages, progress = collected_messages
    frames = [{**time, "landmarks": landmarks(k)} for k in range(N)]

    recording = read_any(json.dumps({**stated, "frames": frames}), progress=progress)

    assert recording.frame_rate == rate
    assert "The times of the file stand still and are not used" in messages


def test_positions_relative_to_the_hips_are_reported(read_any, collected_messages, walk):
    """Otherwise the actor of a phone walks in place without a word."""
    messages, progress = collected_messages
    frames = [{"joints": joints(walk, k, origin=walk["hips"][k])} for k in range(N)]

    read_any(json.dumps(frames), progress=progress)

    assert any("so the actor does not travel" in message for message in messages)


@pytest.mark.parametrize("origin", ["room", "still"])
def test_who_travels_or_stands_still_is_not_reported(
    read_any, collected_messages, walk, origin
):
    messages, progress = collected_messages
    frames = [{"joints": joints(walk, k if origin == "room" else 0)} for k in range(N)]

    read_any(json.dumps(frames), progress=progress)

    assert not any("does not travel" in message for message in messages)


def test_the_joints_of_sam_3d_body_are_recognized(walk):
    """Its 70 points are neither refused nor markers of an archive."""
    points = moving(N, 70)[..., :3].copy()
    columns = {5: "leftUpperArm", 6: "rightUpperArm", 7: "leftLowerArm", 8: "rightLowerArm",
               62: "leftHand", 41: "rightHand", 9: "leftUpperLeg", 10: "rightUpperLeg",
               11: "leftLowerLeg", 12: "rightLowerLeg", 13: "leftFoot", 14: "rightFoot",
               15: "leftToes", 18: "rightToes", 69: "neck", 0: "head"}  # fmt: skip
    for column, role in columns.items():
        points[:, column] = walk[role]

    found = name_joints(points)

    assert found is not None and found.layout == "MHR 70"
    assert np.allclose(found.positions[:, found.names.index("left_wrist")], walk["leftHand"])


@pytest.mark.parametrize("nest", [
    lambda p: {"xyz": dict(zip("xyz", p, strict=True)), "v": p}, lambda p: {"v": p},
])  # fmt: skip
def test_positions_may_be_nested_as_in_the_sdk_of_the_azure_kinect(read_any, walk, nest):
    frames = [{"bodies": [{"id": 1, "joints": joints(walk, k, wrap=nest)}]} for k in range(N)]

    assert "left_wrist" in read_any(json.dumps(frames)).names


@pytest.mark.parametrize("key", ["p", "worldPosition", "coords"])
def test_positions_may_have_any_common_key(read_any, walk, key):
    others = {"localPosition": [0, 0, 0], "q": [0, 0, 0, 1]}
    frames = [
        {"bones": [{"name": each["name"], key: each["position"], **others}
                   for each in joints(walk, k)]}
        for k in range(N)
    ]  # fmt: skip

    assert "left_wrist" in read_any(json.dumps({"fps": 72, "frames": frames})).names


def test_hips_at_the_origin_may_turn(read_any, collected_messages, walk):
    """The middle of the thighs moves around a pelvis that is the origin."""
    messages, progress = collected_messages
    frames = [{"joints": joints(walk, k, origin=walk["hips"][k] + (0.0, 0.0, 0.08 * (k % 2)))}
              for k in range(N)]  # fmt: skip

    read_any(json.dumps(frames), progress=progress)

    assert any("so the actor does not travel" in message for message in messages)


@pytest.mark.parametrize("key", ["v", "p", "value", "location"])
@pytest.mark.parametrize("wrap", [dict, lambda row: {"position": row}])
def test_numbers_next_to_coordinates_are_no_positions(read_any, key, wrap):
    """`v` for visibility or `p` for probability are no coordinates."""
    frames = [{"landmarks": [*map(wrap, landmarks(k, **{key: 0.9}))]} for k in range(N)]

    recording = read_any(json.dumps({"fps": 30, "frames": frames}))

    x, y, z = np.moveaxis(POINTS[..., :3], -1, 0)
    assert np.allclose(recording.tracks.positions[:, :33], np.stack([x, z, -y], axis=-1))


def test_points_of_a_face_do_not_hide_those_of_the_body(read_any):
    frames = [
        {"faceMesh": 14 * landmarks(k), "lm": landmarks(k, visibility=0.9)} for k in range(N)
    ]

    assert read_any(json.dumps({"frames": frames})).sensor is Sensor.MEDIAPIPE


def test_many_coordinates_without_an_end_are_detected_in_a_moment():
    """A search that is not bounded takes 10 seconds for some kilobytes."""
    start = time.process_time()

    assert not is_frames_json(b"{" + 4096 * b'"x":1,"y":1,')

    assert time.process_time() - start < 1.0
