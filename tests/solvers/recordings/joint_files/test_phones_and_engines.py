"""Joints that phones, robots and game engines write come in standing, at their own rate."""

import json

import numpy as np
import pytest
from exports.camera_bodies import mediapipe

from solvers.errors import InvalidFileError
from solvers.motion import roles_by_name
from solvers.motion.humanoid import SIDES
from solvers.motion.skeletons import BODY_POINTS
from solvers.recordings import list_bodies, read_recording

F = 40
RATE_HZ = 15.0
VISION = {"root": "hips", "spine": "spine", "centerShoulder": "neck", "topHead": "head"} | {
    side + part: side + role for side in SIDES for part, role in {
        "Shoulder": "UpperArm", "Elbow": "LowerArm", "Wrist": "Hand", "Hip": "UpperLeg",
        "Knee": "LowerLeg", "Ankle": "Foot",
    }.items()
}  # fmt: skip
"""Joints of Apple Vision, by role."""


@pytest.fixture(scope="module")
def walk(walker):
    return {role: path[:F] for role, path in walker.items()}


def read(tmp_path, content):
    path = tmp_path / "take"
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    return read_recording(path)


def check(recording, walk):
    joints = {role: recording.tracks.positions[:, recording.names.index(name)]
              for role, name in roles_by_name(recording.names).items()}  # fmt: skip
    for role in ("head", "leftHand", "rightLowerLeg"):
        expected = walk[role] - walk["rightUpperLeg"]
        assert np.allclose(joints[role] - joints["rightUpperLeg"], expected, atol=1e-3), role


def test_positions_in_the_picture_are_left_out(tmp_path, walk):
    """As LightBuzz has them; before, there was no body in any frame."""
    frames = [
        {"Timestamp": k / RATE_HZ, "Bodies": [{"ID": 1, "Joints": [
            {"Type": name, "Position2D": {"X": 10.0, "Y": 2.0}, "Confidence": 0.9,
             "Position3D": dict(zip("XYZ", walk[role][k].tolist(), strict=True))}
            for name, role in VISION.items()
        ]}]} for k in range(F)
    ]  # fmt: skip

    recording = read(tmp_path, frames)

    assert recording.frame_rate == RATE_HZ
    check(recording, walk)


def test_points_of_apple_vision(tmp_path, walk):
    frames = [
        {"time": k / RATE_HZ, "points": [
            {"jointName": name, "position": walk[role][k].tolist(), "confidence": 0.9}
            for name, role in VISION.items()
        ]} for k in range(F)
    ]  # fmt: skip

    recording = read(tmp_path, {"frames": frames})

    check(recording, walk)
    assert recording.frame_rate == pytest.approx(RATE_HZ)


@pytest.mark.parametrize(
    "header",
    [
        lambda time: {"header": {"stamp": {"sec": int(time), "nanosec": int(time % 1 * 1e9)}}},
        lambda time: {"header": {"stamp": {"secs": int(time), "nsecs": int(time % 1 * 1e9)},
                                 "frame_id": "camera"}},
        lambda time: {"Header": {"Stamp": time}},
        lambda time: {"metadata": {"timestamp_ms": 1000.0 * time}},
        lambda time: {"stamp": time, "header": {"stamp": 0.0}},
        lambda time: {"time": time, "header": {"stamp_ms": 500.0 * time}},
    ],
)  # fmt: skip
def test_the_time_of_a_message_is_in_its_header(tmp_path, walk, header):
    frames = [
        header(1.7e9 + k / RATE_HZ)
        | {"joints": {role: points[k].tolist() for role, points in walk.items()}}
        for k in range(F)
    ]

    recording = read(tmp_path, "\n".join(map(json.dumps, frames)))

    check(recording, walk)
    assert recording.frame_rate == pytest.approx(RATE_HZ, rel=1e-3)


@pytest.mark.parametrize("axis", ["Location{}", "Translate{}", "Pos{}", "T{}", "location.{}"])
def test_bones_of_an_engine_have_a_line_each(tmp_path, walk, axis):
    titles = ",".join(axis.format(each) for each in "XYZ").replace(".", "_")
    lines = [
        f"{k},{role},{points[k, 0]},{points[k, 1]},{points[k, 2]},0,0,90"
        for k in range(F)
        for role, points in walk.items()
    ]

    recording = read(tmp_path, "\n".join([f"Frame,Bone,{titles},RotX,RotY,RotZ", *lines]))

    check(recording, walk)


def test_hands_next_to_a_body_are_no_person(tmp_path, walk):
    frames = [
        {"body": {role: points[k].tolist() for role, points in walk.items()},
         "leftHand": {f"finger{n}": [0.1 * n, 0.2, 0.3 + k] for n in range(21)}}
        for k in range(F)
    ]  # fmt: skip

    check(read(tmp_path, frames), walk)
    assert "leftHand" not in [body.name for body in list_bodies(tmp_path / "take")]


def landmark_lines(n_people=1):
    return [
        f"{k},{at},{name.upper()},{x},{y},{z},{seen}"
        for k, points in enumerate(mediapipe(F).tolist())
        for _ in range(n_people)
        for at, (name, (x, y, z, seen)) in enumerate(zip(BODY_POINTS, points, strict=True))
    ]


TITLES = "frame,landmark_id,landmark_name,x,y,z,visibility"


def test_landmarks_have_a_number_and_a_name(tmp_path):
    recording = read(tmp_path, "\n".join([TITLES, *landmark_lines()]))

    x, y, z = np.moveaxis(mediapipe(F)[..., :3], -1, 0)
    assert np.allclose(recording.tracks.positions[:, :33], np.stack([x, z, -y], axis=-1))


def test_landmarks_of_two_people_without_their_names_are_refused(tmp_path):
    """No frame holds only the person who was last."""
    with pytest.raises(InvalidFileError, match="has joint NOSE of one person twice in frame 1"):
        read(tmp_path, "\n".join([TITLES, *landmark_lines(2)]))
