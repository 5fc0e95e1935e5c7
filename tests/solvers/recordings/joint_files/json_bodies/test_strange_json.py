"""JSON with empty frames, percentages, several clocks or data of something else is read."""

import json

import numpy as np
import pytest
from exports.camera_bodies import mediapipe
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError
from solvers.motion.skeletons import BODY_POINTS
from solvers.recordings import list_bodies
from solvers.recordings.joint_files import is_frames_json
from solvers.recordings.point_bodies import read_time

N = 40
POINTS = mediapipe(N)


def landmarks(k, **others):
    return [dict(zip("xyz", row, strict=True)) | others for row in POINTS[k, :, :3].tolist()]


@pytest.mark.parametrize("empty", ["[[]]", "[]", "null", "[[], []]"])
def test_many_empty_frames_come_before_the_first_person(read_any, empty):
    """The time of a search that tries all splits of the brackets doubles with each frame."""
    n_empty = 2000
    people = [json.dumps([{"id": 1, "keypoints3D": landmarks(k)}]) for k in range(N)]
    text = f"[{', '.join([empty] * n_empty + people)}]"

    assert is_frames_json(text.encode())
    assert np.isfinite(read_any(text).tracks.positions).all(axis=(1, 2))[-N:].all()


@pytest.mark.parametrize("scale", [1.0, 100.0])
@pytest.mark.parametrize("turn", [(1, 1, 1), (1, -1, -1)])
def test_confidence_may_be_in_percent(read_any, scale, turn):
    """A wrist is seen with 1 % in one frame, and has no stated visibility in another."""
    seen = np.full((N, 33), 0.9)
    seen[3, 15] = 0.01
    frames = [
        {"landmarks": [
            {"x": turn[0] * x, "y": turn[1] * y, "z": turn[2] * z, "visibility": scale * each}
            for (x, y, z), each in zip(POINTS[k, :, :3].tolist(), seen[k].tolist(), strict=True)
        ]}
        for k in range(N)
    ]  # fmt: skip
    del frames[5]["landmarks"][16]["visibility"]

    recording = read_any(json.dumps(frames))

    columns = [recording.names.index(f"{side}_wrist") for side in ("left", "right")]
    found = recording.tracks.confidence[:, columns]
    expected = np.full((N, 2), 0.9)
    expected[3, 0], expected[5, 1] = 0.01, 1.0
    assert_allclose(found, expected)


@pytest.mark.parametrize("n_points", [N, 33])
def test_objects_without_a_position_are_no_points(read_any, n_points):
    frames = [{"landmarks": [{"visibility": 0.5}] * n_points} for _ in range(N)]

    with pytest.raises(InvalidFileError, match="no body"):
        read_any(json.dumps(frames))


def test_a_joint_without_a_position_is_not_observed(read_any):
    frames = [{"landmarks": landmarks(k)} for k in range(N)]
    frames[3]["landmarks"][15] = {"visibility": 0.0}

    positions = read_any(json.dumps(frames)).tracks.positions

    assert np.argwhere(np.isnan(positions[:, :33]).any(axis=2)).tolist() == [[3, 15]]


def by_name(k):
    return dict(zip(BODY_POINTS, POINTS[k, :, :3].tolist(), strict=True))


def turning(k):
    return {name: [0.0, 0.1 * k, at / 9] for at, name in enumerate(BODY_POINTS)}


@pytest.mark.parametrize("nest", [
    lambda k: {"velocity": turning(k), "position": by_name(k)},
    lambda k: {"rotations": turning(k), "velocities": turning(k), "global": by_name(k)},
    lambda k: by_name(k) | {f"{name}_velocity": at for name, at in turning(k).items()},
])  # fmt: skip
def test_velocities_and_rotations_are_no_positions(tmp_path, read_any, nest):
    recording = read_any(json.dumps([nest(k) for k in range(N)]))

    assert len(list_bodies(tmp_path / "take.dat")) == 0
    nose, hip = (recording.names.index(name) for name in ("nose", "left_hip"))
    found = recording.tracks.positions[:, nose] - recording.tracks.positions[:, hip]
    expected = POINTS[:, 0, :3] - POINTS[:, 23, :3]
    assert_allclose(np.linalg.norm(found, axis=1), np.linalg.norm(expected, axis=1))


@pytest.mark.parametrize("key", ["rotations", "velocities", "Quaternion", "angles"])
def test_rotations_alone_are_no_body(read_any, key):
    with pytest.raises(InvalidFileError, match=r"no body|rotations of bones"):
        read_any(json.dumps([{key: turning(k)} for k in range(N)]))


@pytest.mark.parametrize("text", ["inf", "-Infinity", "nan", "1e999"])
def test_times_without_bounds_are_no_times(text):
    time, second = read_time(text, 1e-3)

    assert np.isnan(time)
    assert second == 1e-3


@pytest.mark.parametrize("third", [0.0, 0.9])
def test_named_points_of_a_picture_are_refused(read_any, third):
    frames = [
        {"keypoints": {
            name: [320 + 100 * x, 240 + 100 * y, third + 0.001 * k * third]
            for name, (x, y, _) in by_name(k).items() if "hip" in name or not name.endswith("x")
        }}
        for k in range(N)
    ]  # fmt: skip
    for frame in frames:
        frame["keypoints"].pop("nose")

    with pytest.raises(InvalidFileError, match="2D points of images"):
        read_any(json.dumps(frames))


def test_seconds_and_nanoseconds_are_one_time(read_any):
    for wrap in (dict, lambda stamp: {"timestamp": stamp}):
        frames = [
            wrap({"sec": 1_700_000_000 + k // 50, "nanosec": k % 50 * 20_000_000})
            | {"landmarks": landmarks(k)}
            for k in range(N)
        ]

        assert read_any(json.dumps(frames)).frame_rate == 50


def test_a_clock_that_stands_still_is_ignored(read_any):
    frames = [{"time": k / 50, "timestamp_ms": 0, "landmarks": landmarks(k)} for k in range(N)]

    assert read_any(json.dumps(frames)).frame_rate == 50


@pytest.mark.parametrize("header", [{"meta": 1}, {"program": "x", "version": 2.5}])
def test_a_header_line_is_no_frame(read_any, header):
    lines = [header, *({"landmarks": landmarks(k)} for k in range(N))]

    assert len(read_any("\n".join(map(json.dumps, lines))).tracks.positions) == N


@pytest.mark.parametrize("first", [{"frame": 0}, {"t": 0.0}, {"landmarks": []}])
def test_a_frame_without_a_person_is_no_header(read_any, first):
    time = {"t": 0.02} if "t" in first else {}
    lines = [first, *({key: k * step for key, step in time.items()}
                      | {"landmarks": landmarks(k)} for k in range(1, N))]  # fmt: skip

    positions = read_any("\n".join(map(json.dumps, lines))).tracks.positions

    assert np.isfinite(positions).all(axis=(1, 2))[-N + 1 :].all()


UNIDENTIFIED = {
    "people": lambda pair: {"people": [{"joints": each} for each in pair]},
    "lists": lambda pair: [[*each.values()] for each in pair],
    "landmarks": lambda pair: {"landmarks": [[*each.values()] for each in pair]},
}
IDENTITIES = {
    "id": lambda pair: {"people": [{"id": k, "joints": each} for k, each in enumerate(pair)]},
    "name": lambda pair: {"people": [{"name": f"n{k}", "joints": each}
                                     for k, each in enumerate(pair)]},
}  # fmt: skip


@pytest.mark.parametrize("nest", [*UNIDENTIFIED, *IDENTITIES])
def test_people_who_may_be_swapped_are_reported(read_any, collected_messages, nest):
    messages, progress = collected_messages
    frames = [(UNIDENTIFIED | IDENTITIES)[nest]([by_name(k), by_name(k)]) for k in range(N)]

    read_any(json.dumps(frames), body="0" if nest != "name" else "n0", progress=progress)

    reported = [each for each in messages if "without an identity" in each]
    assert len(reported) == (nest in UNIDENTIFIED)
    assert all(each.startswith(f"{N} frames") for each in reported)
