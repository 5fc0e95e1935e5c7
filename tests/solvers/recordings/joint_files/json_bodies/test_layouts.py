"""JSON of any program comes in as the body whose joints it names, however these are nested."""

import json

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import JointRecording, roles_by_name
from solvers.motion.humanoid import SIDES
from solvers.recordings import list_bodies, read_recording

F = 30
PARTS = {"shoulder": "UpperArm", "elbow": "LowerArm", "wrist": "Hand", "hip": "UpperLeg",
         "knee": "LowerLeg", "ankle": "Foot"}  # fmt: skip
LANDMARKS = {f"{side}_{part}": side + role for side in SIDES for part, role in PARTS.items()}
OF_ARKIT = {"arm": "UpperArm", "forearm": "LowerArm", "hand": "Hand", "upLeg": "UpperLeg",
            "leg": "LowerLeg", "foot": "Foot"}  # fmt: skip
ARKIT = {"hips_joint": "hips", "head_joint": "head"} | {
    f"{side}_{part}_joint": side + role for side in SIDES for part, role in OF_ARKIT.items()
}


@pytest.fixture(scope="module")
def walk(walker):
    """Positions of joints by role, meters, Y up."""
    y_up = (1.0, 1.0, -1.0)
    return {role: path[:F, [0, 2, 1]] * y_up for role, path in walker.items()}


def matrix(point, by_rows):
    pose = np.eye(4)
    pose[:3, 3] = point
    return (pose if by_rows else pose.T).ravel().tolist()


def coordinates(point):
    return dict(zip("xyz", point.tolist(), strict=True))


def skeletons(names, frame):
    """Return what Nuitrack's files have, too, with other joints."""
    joints = {name: coordinates(point) for name, point in frame.items()}
    return {"skeletons": [{"id": 0, "joints": joints}]}


def paths(names, frames):
    """Return the places of each joint in all frames."""
    return {name: [frame[name].tolist() for frame in frames] for name in names}


def by_name(frame, form=coordinates):
    return {name: form(point) for name, point in frame.items()}


LAYOUTS = {
    "by joint": lambda names, frames: {"origin": {"x": 0, "y": 0, "z": 0}, "units": None}
    | paths(names, frames),
    "by joint, below a key": lambda names, frames: {"fps": 30, "joints": paths(names, frames)},
    "by joint and axis": lambda names, frames: {
        name: {axis: [point[k] for point in path] for k, axis in enumerate("xyz")}
        for name, path in paths(names, frames).items()
    },
    "by number, in the order of texts": lambda names, frames: dict(sorted(
        (str(k), by_name(frame, np.ndarray.tolist)) for k, frame in enumerate(frames)
    )),
    "by number, below a key": lambda names, frames: {
        "unit": "m", "frames": {f"frame_{k}": by_name(frame) for k, frame in enumerate(frames)},
    },
    "by time": lambda names, frames: {
        f"{k / 30:.4f}": by_name(frame) for k, frame in enumerate(frames)
    },
    "list of names": lambda names, frames: [by_name(frame) for frame in frames],
    "list of names and more": lambda names, frames: [
        {"frame": k, "time": k / 30, "camera": [0, 0, 0, 1]}
        | {name: {"position": point.tolist(), "rotation": [0, 0, 0, 1]}
           for name, point in frame.items()}
        for k, frame in enumerate(frames)
    ],
    "names below a key": lambda names, frames: [
        {"frame": k, "data": by_name(frame)} for k, frame in enumerate(frames)
    ],
    "skeletons": lambda names, frames: [skeletons(names, frame) for frame in frames],
    "matrices by columns": lambda names, frames: {
        "frames": [
            {"joints": {name: matrix(point, False) for name, point in frame.items()}}
            for frame in frames
        ]
    },
    "matrices by rows": lambda names, frames: [
        {"joints": {name: np.reshape(matrix(point, True), (4, 4)).tolist()
                    for name, point in frame.items()}}
        for frame in frames
    ],
    "bones": lambda names, frames: {
        "frames": [
            {"bones": [{"id": k, "name": name, "position": coordinates(point),
                        "rotation": {"x": 0, "y": 0, "z": 0, "w": 1}}
                       for k, (name, point) in enumerate(frame.items())]}
            for frame in frames
        ]
    },
    "members of C#": lambda names, frames: [
        {"Timestamp": k / 30,
         "Joints": {name: {"Position": dict(zip("XYZ", point.tolist(), strict=True)),
                           "TrackingState": 2} for name, point in frame.items()}}
        for k, frame in enumerate(frames)
    ],
    "Kinect v2": lambda names, frames: [
        {"bodies": [{"trackingId": "72057594037927936", "joints": [
            {"jointType": name, "cameraX": x, "cameraY": y, "cameraZ": z, "trackingState": 2}
            for name, (x, y, z) in by_name(frame, np.ndarray.tolist).items()
        ]}]}
        for frame in frames
    ],
    "joint_name": lambda names, frames: [
        {"skeletons": [{"joints": [
            {"type": "joint", "joint_name": name, "position": coordinates(point)}
            for name, point in frame.items()
        ]}]}
        for frame in frames
    ],
    "names apart and skeletons": lambda names, frames: {
        "joint_names": list(names), "frames": [skeletons(names, frame) for frame in frames],
    },
    "names apart": lambda names, frames: {
        "joint_names": list(names),
        "positions": [[point.tolist() for point in frame.values()] for frame in frames],
    },
}  # fmt: skip


@pytest.mark.parametrize("names", [LANDMARKS, ARKIT])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_named_joints_are_read(tmp_path, walk, layout, names):
    frames = [{name: walk[role][k] for name, role in names.items()} for k in range(F)]
    path = tmp_path / "take.json"
    path.write_text(json.dumps(LAYOUTS[layout](names, frames)))

    recording = read_recording(path)

    assert isinstance(recording, JointRecording)
    joints = {
        role: recording.tracks.positions[:, recording.names.index(name)]
        for role, name in roles_by_name(recording.names).items()
    }
    for role in ("leftHand", "rightLowerLeg", "leftFoot"):
        expected = (walk[role] - walk["rightUpperLeg"])[..., [0, 2, 1]] * (1.0, -1.0, 1.0)
        found = joints[role] - joints["rightUpperLeg"]
        assert np.allclose(found, expected, atol=1e-4), role


def write(path, content):
    path.write_text(json.dumps(content))
    return path


def test_frames_by_number_are_in_the_order_of_numbers_with_gaps(tmp_path, walk):
    frames = [{name: walk[role][k].tolist() for name, role in LANDMARKS.items()}
              for k in range(F)]  # fmt: skip
    numbered = {str(k): frame for k, frame in enumerate(frames) if k not in {4, 5}}
    path = write(tmp_path / "take.json", dict(sorted(numbered.items())))

    recording = read_recording(path)

    missing = np.isnan(recording.tracks.positions).all(axis=(1, 2))
    assert np.flatnonzero(missing).tolist() == [4, 5]
    rise = np.diff(recording.tracks.positions[:, recording.names.index("left_wrist"), 2])
    assert np.nanmax(np.abs(rise - np.diff(walk["leftHand"][:, 1]))) < 1e-6


@pytest.mark.parametrize("by_frame", [True, False])
def test_numbers_are_those_of_frames_or_of_joints(tmp_path, walk, by_frame):
    limbs = {side: [walk[side + role] for role in PARTS.values()] for side in SIDES}
    points = [walk["head"]] * 5 + [limbs[side][k] for k in range(6) for side in SIDES]
    positions = np.stack(points, axis=0 if not by_frame else 1)
    content = {str(k): each.tolist() for k, each in enumerate(positions)}

    recording = read_recording(write(tmp_path / "take.json", content))

    assert recording.tracks.n_frames == F
    assert "left_elbow" in recording.names


def test_people_by_name_are_several(tmp_path, walk):
    frames = [
        {who: {name: walk[role][k].tolist() for name, role in LANDMARKS.items()}
         for who in ("anna", "ben")}
        for k in range(F)
    ]  # fmt: skip

    bodies = list_bodies(write(tmp_path / "take.json", frames))

    assert [body.name for body in bodies] == ["anna", "ben"]


def test_joints_with_different_numbers_of_frames_are_refused(tmp_path, walk):
    content = {name: walk[role].tolist() for name, role in LANDMARKS.items()}
    content["left_knee"].pop()

    with pytest.raises(InvalidFileError, match="29 frames of left_knee, but 30 of"):
        read_recording(write(tmp_path / "take.json", content))


def test_quaternions_by_joint_are_no_positions(tmp_path, rng):
    rotations = rng.normal(size=(F, len(LANDMARKS), 4))
    rotations /= np.linalg.norm(rotations, axis=2, keepdims=True)
    content = dict(zip(LANDMARKS, np.swapaxes(rotations, 0, 1).tolist(), strict=True))

    with pytest.raises(InvalidFileError, match="no body"):
        read_recording(write(tmp_path / "take.json", content))


def test_unknown_names_separate_from_the_positions_are_ignored(tmp_path, walk):
    """Joints in a known order are recognized by their bones."""
    limbs = {side: [walk[side + role] for role in PARTS.values()] for side in SIDES}
    points = [walk["head"]] * 5 + [limbs[side][k] for k in range(6) for side in SIDES]
    positions = np.stack(points, axis=1).tolist()
    path = tmp_path / "take.json"
    path.write_text(json.dumps({"names": [f"J{k}" for k in range(17)], "positions": positions}))

    assert "left_elbow" in read_recording(path).names


def named(walk, k):
    return {name: walk[role][k].tolist() for name, role in LANDMARKS.items()}


def test_null_among_frames_is_a_frame_without_a_body(tmp_path, walk):
    frames = [None if k in {0, 7} else named(walk, k) for k in range(F)]

    recording = read_recording(write(tmp_path / "take.json", {"fps": 30, "frames": frames}))

    missing = np.isnan(recording.tracks.positions).all(axis=(1, 2))
    assert (len(missing), np.flatnonzero(missing).tolist()) == (F, [0, 7])


def test_null_at_the_begin_of_the_path_of_a_joint_is_a_missing_place(tmp_path, walk):
    content = {name: [None, *walk[role][1:].tolist()] for name, role in LANDMARKS.items()}

    recording = read_recording(write(tmp_path / "take.json", content))

    missing = np.isnan(recording.tracks.positions).all(axis=(1, 2))
    assert (len(missing), np.flatnonzero(missing).tolist()) == (F, [0])


def test_frame_with_a_place_of_its_own_is_no_joint(tmp_path, walk):
    frames = [{"translation": [0, 0, 1], "joints": named(walk, k)} for k in range(F)]

    recording = read_recording(write(tmp_path / "take.json", {"frames": frames}))

    assert recording.tracks.n_frames == F


@pytest.mark.parametrize("inside", [lambda joints: joints, lambda joints: {"joints": joints}])
@pytest.mark.parametrize("wrap", [
    lambda frames: frames,
    lambda frames: {"frames": [None, *frames[1:]]},
    lambda frames: {"frames": {str(k): frame for k, frame in enumerate(frames)}},
    lambda frames: {str(k): frame for k, frame in enumerate(frames)},
    lambda frames: {
        str(k): [{"id": who, "joints": joints.get("joints", joints)}
                 for who, joints in frame.items()]
        for k, frame in enumerate(frames)
    },
])  # fmt: skip
def test_numbers_in_a_frame_are_those_of_people(tmp_path, walk, wrap, inside):
    """Two people are never one who jumps."""
    frames = [{who: inside(named(walk, k)) for who in ("1", "2")} for k in range(F)]

    bodies = list_bodies(write(tmp_path / "take.json", wrap(frames)))

    assert [body.name for body in bodies] == ["1", "2"]
    assert {body.n_frames for body in bodies} <= {F - 1, F}


def test_very_large_gaps_between_numbers_are_refused(tmp_path, walk):
    content = {str(k): named(walk, 0) for k in (0, 1, 2_000, 1_000_000)}

    with pytest.raises(InvalidFileError, match="lacks 999997 frames between 0 and 1000000"):
        read_recording(write(tmp_path / "take.json", content))


def test_a_long_gap_keeps_its_length(tmp_path, walk):
    content = {str(k): named(walk, k % F) for k in (*range(9), *range(1509, 1520))}

    assert read_recording(write(tmp_path / "take.json", content)).tracks.n_frames == 1520
