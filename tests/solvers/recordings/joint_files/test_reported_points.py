"""Points that come in otherwise than their author meant are reported."""

import json

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import Tracks
from solvers.recordings import read_recording

F = 20


@pytest.fixture(scope="module")
def walk(walker):
    """Positions of the joints of a walker on the spot, by VRM's names, meters, Z up."""
    path_on_floor = walker["hips"][:F] * (1, 1, 0)
    return {role: path[:F] - path_on_floor for role, path in walker.items()}


def read(path, joints):
    """Return what a table of these joints becomes, and what was said."""
    titles = [f"{name}_{axis}" for name in joints for axis in "xyz"]
    rows = np.concatenate([*joints.values()], axis=1)
    lines = [",".join(titles), *(",".join(f"{each:.5f}" for each in row) for row in rows)]
    path.write_text("\n".join(lines) + "\n")
    said = []
    recording = read_recording(path, progress=lambda _, text="": said.append(str(text)))
    return recording, " ".join(said)


def test_a_body_without_a_limb_is_imported_as_markers_and_reported(tmp_path, walk):
    complete, said = read(tmp_path / "whole.csv", walk)
    assert not isinstance(complete, Tracks) and "lack" not in said
    walk = {role: points for role, points in walk.items() if role != "leftHand"}

    recording, said = read(tmp_path / "take.csv", walk)

    assert isinstance(recording, Tracks)
    assert "The points lack left_wrist of a body and are imported as markers" in said


def test_an_up_axis_that_no_table_has_is_a_question(tmp_path, walk):
    """Z down, as of drones and old game engines: where the actor bows, Y seems to be up."""
    hips = walk["hips"]
    forward = np.radians(60.0)
    bow = np.array([[1, 0, 0], [0, np.cos(forward), -np.sin(forward)],
                    [0, np.sin(forward), np.cos(forward)]])  # fmt: skip
    bowed = {
        role: points if "Leg" in role or "Foot" in role or "Toes" in role
        else hips + (points - hips) @ bow.T
        for role, points in walk.items()
    }  # fmt: skip

    upright, said = read(tmp_path / "upright.csv", bowed)
    assert "set Up" not in said
    _, said = read(tmp_path / "take.csv", {r: each * (1, -1, -1) for r, each in bowed.items()})

    assert np.nanmax(upright.tracks.positions[..., 2]) > 1.0
    assert "set Up if the actor lies on its side" in said


def test_one_frame_by_joint_is_refused_as_one_frame(tmp_path, walk):
    path = tmp_path / "take.json"
    path.write_text(json.dumps({role: points[:1].tolist() for role, points in walk.items()}))

    with pytest.raises(InvalidFileError, match="holds the joints of one frame"):
        read_recording(path)
