"""MediaPipe's landmarks in JSON are read however a program has nested, named and timed them."""

import json

import numpy as np
import pytest
from exports.camera_bodies import mediapipe
from numpy.testing import assert_allclose

from solvers.motion import Sensor
from solvers.motion.skeletons import BODY_POINTS
from solvers.recordings import list_bodies

N = 40
RATE_HZ = 25.0
POINTS = mediapipe(N)
X, Y, Z = np.moveaxis(POINTS[..., :3], -1, 0)
EXPECTED = np.stack([X, Z, -Y], axis=-1)
"""By definition of MediaPipe: x right, y down, z away from the camera."""


def objects(k):
    return [dict(zip(("x", "y", "z", "visibility"), row, strict=True))
            for row in POINTS[k].tolist()]  # fmt: skip


def by_name(k, write=str):
    return {write(name): POINTS[k, at, :3].tolist() for at, name in enumerate(BODY_POINTS)}


def camel(name):
    first, *others = name.split("_")
    return first + "".join(map(str.title, others))


LAYOUTS = {
    "by name": [{"landmarks": by_name(k)} for k in range(N)],
    "by capital name": [{"world_landmarks": by_name(k, str.upper)} for k in range(N)],
    "by name in JavaScript": [{"poseWorldLandmarks": by_name(k, camel)} for k in range(N)],
    "99 numbers": [{"landmarks": POINTS[k, :, :3].ravel().tolist()} for k in range(N)],
    "132 numbers": {"frames": [{"landmarks": POINTS[k].ravel().tolist()} for k in range(N)]},
    "frames of a member": {"fps": RATE_HZ, "landmarks": [objects(k) for k in range(N)]},
    "people of a frame": [{"pose_world_landmarks": [objects(k)]} for k in range(N)],
    "a wrapper next to hands": [
        {"pose": {"landmarks": objects(k)}, "left_hand": {"landmarks": objects(k)[:21]}}
        for k in range(N)
    ],
    "TensorFlow": [
        [{"score": 0.9, "keypoints3D": [{"name": name, **point} for name, point
                                        in zip(BODY_POINTS, objects(k), strict=True)]}]
        for k in range(N)
    ],
    "by number": [{str(at): point for at, point in enumerate(objects(k))} for k in range(N)],
    "text": [
        {"landmarks": [{axis: str(each[axis]) for axis in each} for each in objects(k)]}
        for k in range(N)
    ],
}  # fmt: skip


@pytest.mark.parametrize("layout", LAYOUTS)
def test_landmarks_are_found_in_any_layout(read_any, layout):
    recording = read_any(json.dumps(LAYOUTS[layout]))

    assert recording.sensor is Sensor.MEDIAPIPE
    assert_allclose(recording.tracks.positions[:, :33], EXPECTED, atol=1e-9)


@pytest.mark.parametrize("nest", [lambda body: body, lambda body: [body]])
@pytest.mark.parametrize("body", [objects, lambda k: POINTS[k, :, :3].tolist()])
def test_frames_without_a_person_are_empty_lists(read_any, nest, body):
    """A program that saves its results as they come has no keys at all."""
    missing = [0, 1, 7]

    recording = read_any(json.dumps([[] if k in missing else nest(body(k)) for k in range(N)]))

    seen = np.isfinite(recording.tracks.positions).all(axis=(1, 2))
    assert np.flatnonzero(~seen).tolist() == missing
    nose = recording.names.index("nose")
    hips = recording.names.index("left_hip")
    found = recording.tracks.positions[:, nose] - recording.tracks.positions[:, hips]
    assert_allclose(found[seen], (EXPECTED[:, 0] - EXPECTED[:, 23])[seen], atol=1e-9)


def test_flat_rows_without_keys_are_read(read_any):
    rows = [POINTS[k, :, :3].ravel().tolist() for k in range(N)]

    recording = read_any(json.dumps(rows))

    assert_allclose(recording.tracks.positions[:, :33], EXPECTED, atol=1e-9)


@pytest.mark.parametrize("key", ["timestamps", "times", "t"])
@pytest.mark.parametrize("second", [1, 1e3, 1e6, 1e9])
def test_times_next_to_the_frames_give_the_rate(read_any, key, second):
    times = [k / RATE_HZ if second == 1 else round(second * k / RATE_HZ) for k in range(N)]

    recording = read_any(json.dumps({key: times, "frames": [
        {"landmarks": objects(k)} for k in range(N)
    ]}))  # fmt: skip

    assert recording.frame_rate == RATE_HZ


@pytest.mark.parametrize(("key", "time"), [
    ("timestamp_us", lambda s: round(1e6 * s)), ("timeStampNs", lambda s: round(1e9 * s)),
    ("Time (ms)", lambda s: 1e3 * s), ("seconds", lambda s: s), ("time", str),
    ("timestamp", lambda s: f"2026-03-01T10:59:59.{round(1e6 * s):06d}Z"),
])  # fmt: skip
def test_times_of_frames_may_state_their_unit_or_be_dates(read_any, key, time):
    rate = 50.0
    frames = [{key: time(k / rate), "landmarks": objects(k)} for k in range(N)]

    assert read_any(json.dumps(frames)).frame_rate == rate


def test_a_value_of_json_in_each_line_is_a_frame(read_any):
    lines = [json.dumps({"t": k / RATE_HZ, "landmarks": objects(k)}) for k in range(N)]

    recording = read_any("\n".join(lines) + "\n")

    assert recording.frame_rate == RATE_HZ
    assert_allclose(recording.tracks.positions[:, :33], EXPECTED, atol=1e-9)


def test_a_landmark_that_is_null_is_not_observed(read_any):
    frames = [{"landmarks": objects(k)} for k in range(N)]
    frames[3]["landmarks"][15] = None
    frames[4]["landmarks"][16]["x"] = None

    positions = read_any(json.dumps(frames)).tracks.positions

    assert np.argwhere(np.isnan(positions[:, :33]).any(axis=2)).tolist() == [[3, 15], [4, 16]]


def test_two_people_by_their_order_in_a_list_can_be_chosen(make_writer):
    other = [{**each, "x": -each["x"]} for each in objects(0)]
    frames = [{"landmarks": [objects(k), other]} for k in range(N)]

    assert [each.name for each in list_bodies(make_writer("two.json")(json.dumps(frames)))] == [
        "0", "1"
    ]  # fmt: skip


@pytest.mark.parametrize("turned", [
    (X, -Y, -Z), (X, Z, -Y), (-X, -Z, -Y), (X, -Y, Z),
], ids=["y up", "z up", "z up, from behind", "y up, mirrored"])  # fmt: skip
def test_landmarks_that_a_program_turned_stand_too(read_any, collected_messages, turned):
    """Otherwise an actor with Y up comes in on the head, without a word."""
    messages, progress = collected_messages
    frames = [{"landmarks": body.tolist()} for body in np.stack(turned, axis=-1)]

    recording = read_any(json.dumps(frames), progress=progress)

    found = recording.tracks.positions[:, [recording.names.index(name) for name in (
        "nose", "left_ankle", "left_wrist", "right_wrist")]]  # fmt: skip
    expected = EXPECTED[:, [0, 27, 15, 16]]
    assert_allclose(found[..., 2], expected[..., 2], atol=1e-9)
    distances = np.linalg.norm(found[:, :, None] - found[:, None], axis=-1)
    wanted = np.linalg.norm(expected[:, :, None] - expected[:, None], axis=-1)
    assert_allclose(distances, wanted, atol=1e-9)
    sides = np.cross(found[:, 2] - found[:, 1], found[:, 3] - found[:, 1])
    front = np.einsum("ij,ij->i", sides, found[:, 0] - found[:, 1])
    wanted_sides = np.cross(expected[:, 2] - expected[:, 1], expected[:, 3] - expected[:, 1])
    wanted_front = np.einsum("ij,ij->i", wanted_sides, expected[:, 0] - expected[:, 1])
    assert_allclose(front, wanted_front, atol=1e-9)
    assert any("is interpreted as up" in message for message in messages)
