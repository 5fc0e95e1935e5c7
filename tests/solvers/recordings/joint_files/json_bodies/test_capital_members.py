"""Programs in C# begin the members of JSON with a capital."""

import json

import numpy as np
import pytest

from solvers.motion import find_humanoid_map, forward_kinematics
from solvers.recordings import list_bodies, read_recording
from solvers.samples import walking_gait

F = 30
DISTANCE_M = 2.0
PARTS = {"Shoulder": "UpperArm", "Elbow": "LowerArm", "Wrist": "Hand", "Hip": "UpperLeg",
         "Knee": "LowerLeg", "Ankle": "Foot"}  # fmt: skip


@pytest.fixture(scope="module")
def two():
    """Return the joints of the first or second of two walkers in a frame, meters, Y up."""
    motion = walking_gait()
    positions = forward_kinematics(motion).positions[:F][..., [0, 2, 1]] * (1.0, 1.0, -1.0)
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)

    def joints(who, frame):
        aside = np.array((DISTANCE_M * who, 0.0, 0.0))
        points = {
            f"{side.title()}{part}": positions[frame, roles[side + role]]
            for part, role in PARTS.items() for side in ("left", "right")
        }  # fmt: skip
        return {
            name: dict(zip("XYZ", (position + aside).tolist(), strict=True))
            for name, position in points.items()
        }

    return joints


def test_people_keep_their_identity_where_their_order_changes(tmp_path, two):
    """None of them jumps to the other's place and back."""
    frames = [
        {"Bodies": [
            {"TrackingId": 7201 + who, "Joints": two(who, k)}
            for who in ((0, 1) if k % 2 == 0 else (1, 0))
        ]}
        for k in range(F)
    ]  # fmt: skip
    path = write(tmp_path, {"Frames": frames})

    assert [(body.name, body.n_frames) for body in list_bodies(path)] == [
        ("7201", F), ("7202", F),
    ]  # fmt: skip
    tracks = read_recording(path, body="7201").tracks
    assert np.abs(np.diff(tracks.positions, axis=0)).max() < DISTANCE_M / 2.0


@pytest.mark.parametrize("key", ["FrameRate", "Fps", "FPS"])
def test_the_rate_is_read(tmp_path, two, key):
    path = write(tmp_path, {key: 60, "Frames": [{"Joints": two(0, k)} for k in range(F)]})

    assert read_recording(path).tracks.frame_rate == 60.0


def test_numbers_and_times_are_read(tmp_path, two):
    kept = [k for k in range(F) if k not in {4, 5}]
    numbered = [{"Frame": k, "Joints": two(0, k)} for k in kept]
    timed = [{"Timestamp_ms": 10.0 * k, "Joints": two(0, k)} for k in range(F)]

    missing = np.isnan(read_recording(write(tmp_path, numbered)).tracks.positions)
    assert np.flatnonzero(missing.all(axis=(1, 2))).tolist() == [4, 5]
    assert read_recording(write(tmp_path, timed)).tracks.frame_rate == pytest.approx(100.0)


def test_people_by_name_are_found(tmp_path, two):
    frames = [{"anna": {"Joints": two(0, k)}, "ben": {"Joints": two(1, k)}} for k in range(F)]

    assert [body.name for body in list_bodies(write(tmp_path, frames))] == ["anna", "ben"]


def test_frames_with_the_position_of_the_camera_are_no_joints(tmp_path, two):
    """Frames are no positions of a joint, and the folder is not read instead."""
    position = {"X": 0.0, "Y": 0.0, "Z": 0.0}
    frames = [{"Joints": two(0, k), "Position": position} for k in range(F)]
    write(tmp_path, {"Frames": frames}, "take_2.json")
    path = write(tmp_path, {"Frames": frames}, "take_1.json")

    said = []
    recording = read_recording(path, progress=lambda _, text="": said.append(str(text)))

    assert recording.tracks.n_frames == F
    assert "files in the folder" not in " ".join(said)


def write(folder, content, name="take.json"):
    path = folder / name
    path.write_text(json.dumps(content))
    return path
