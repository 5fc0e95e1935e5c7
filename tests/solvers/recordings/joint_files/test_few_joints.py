"""Tables of a few joints are markers, if their names are those of joints."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError
from solvers.motion import find_humanoid_map, forward_kinematics
from solvers.samples import walking_gait

F = 40
TRACKERS = {
    "head": "head", "waist": "hips", "left_hand": "leftHand", "right_hand": "rightHand",
    "left_foot": "leftFoot", "right_foot": "rightFoot",
}  # fmt: skip
LEG = {"LHip": "leftUpperLeg", "LKnee": "leftLowerLeg", "LAnkle": "leftFoot"}


@pytest.fixture(scope="module")
def walk():
    """Positions by role in meters, Z up."""
    motion = walking_gait()
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    positions = forward_kinematics(motion).positions[:F]
    return {role: positions[:, at] for role, at in roles.items()}


def table(names, walk):
    titles = ["time", *(f"{name}_{axis}" for name in names for axis in "xyz")]
    points = np.stack([walk[role] for role in names.values()], axis=1).reshape(F, -1)
    rows = [
        ",".join([f"{k / 50:.2f}", *(f"{v:.6f}" for v in row)]) for k, row in enumerate(points)
    ]
    return "\n".join([",".join(titles), *rows])


@pytest.mark.parametrize("names", [TRACKERS, LEG])
def test_a_few_joints_are_read_as_markers(read_any, walk, names):
    """Before, they were refused as too few for a body."""
    tracks = read_any(table(names, walk))

    assert tracks.names == tuple(names)
    assert tracks.frame_rate == 50.0
    expected = np.stack([walk[role] for role in names.values()], axis=1)
    assert_allclose(tracks.positions, expected, atol=1e-4)


def test_it_is_said_that_they_are_no_complete_body(make_reader, walk, collected_messages):
    messages, progress = collected_messages

    make_reader("take.csv")(table(LEG, walk), progress=progress)

    assert any("a few joints of a body" in str(message) for message in messages)


@pytest.mark.parametrize("names", [{"a": "hips", "b": "head", "c": "leftFoot"},
                                   {"head": "head", "hips": "hips"}])  # fmt: skip
def test_a_few_points_without_names_of_joints_are_refused(read_any, walk, names):
    with pytest.raises(InvalidFileError, match="too few for a body"):
        read_any(table(names, walk))
