"""JSON of any program comes in as the body whose joints it names, however these are nested."""

import json

import numpy as np
import pytest

from solvers.motion import JointRecording, find_humanoid_map, forward_kinematics, roles_by_name
from solvers.recordings import read_recording
from solvers.samples import walking_gait

F = 30
SIDES = ("left", "right")
PARTS = {"shoulder": "UpperArm", "elbow": "LowerArm", "wrist": "Hand", "hip": "UpperLeg",
         "knee": "LowerLeg", "ankle": "Foot"}  # fmt: skip
LANDMARKS = {f"{side}_{part}": side + role for side in SIDES for part, role in PARTS.items()}
OF_ARKIT = {"arm": "UpperArm", "forearm": "LowerArm", "hand": "Hand", "upLeg": "UpperLeg",
            "leg": "LowerLeg", "foot": "Foot"}  # fmt: skip
ARKIT = {"hips_joint": "hips", "head_joint": "head"} | {
    f"{side}_{part}_joint": side + role for side in SIDES for part, role in OF_ARKIT.items()
}


@pytest.fixture(scope="module")
def walk():
    """Positions of the joints of a walker by their role, meters, Y up."""
    motion = walking_gait()
    positions = forward_kinematics(motion).positions[:F][..., [0, 2, 1]] * (1.0, 1.0, -1.0)
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    return {role: positions[:, joint] for role, joint in roles.items()}


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


LAYOUTS = {
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


def test_unknown_names_apart_from_the_positions_are_ignored(tmp_path, walk):
    """Joints in a known order are recognized by their bones."""
    limbs = {side: [walk[side + role] for role in PARTS.values()] for side in SIDES}
    points = [walk["head"]] * 5 + [limbs[side][k] for k in range(6) for side in SIDES]
    positions = np.stack(points, axis=1).tolist()
    path = tmp_path / "take.json"
    path.write_text(json.dumps({"names": [f"J{k}" for k in range(17)], "positions": positions}))

    assert "left_elbow" in read_recording(path).names
