"""Tables of joints that begin with the same word, that are few, or that lack the head."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError
from solvers.motion.skeletons import BODY_POINTS

F = 40
TRACKERS = {
    "head": "head", "waist": "hips", "left_hand": "leftHand", "right_hand": "rightHand",
    "left_foot": "leftFoot", "right_foot": "rightFoot",
}  # fmt: skip
LEG_BEHIND_ITS_SIDE = {
    "L_Hip": "leftUpperLeg", "L_Knee": "leftLowerLeg", "L_Ankle": "leftFoot",
}  # fmt: skip
LEG = {"LHip": "leftUpperLeg", "LKnee": "leftLowerLeg", "LAnkle": "leftFoot"}


@pytest.fixture(scope="module")
def walk(walker):
    return {role: path[:F] for role, path in walker.items()}


def table(names, walk):
    titles = ["time", *(f"{name}_{axis}" for name in names for axis in "xyz")]
    points = np.stack([walk[role] for role in names.values()], axis=1).reshape(F, -1)
    rows = [
        ",".join([f"{k / 50:.2f}", *(f"{v:.6f}" for v in row)]) for k, row in enumerate(points)
    ]
    return "\n".join([",".join(titles), *rows])


@pytest.mark.parametrize("names", [TRACKERS, LEG, LEG_BEHIND_ITS_SIDE])
def test_a_few_joints_are_read_as_markers(read_any, walk, names):
    """They are not refused as too few for a body."""
    tracks = read_any(table(names, walk))

    assert tracks.names == tuple(names)
    assert tracks.frame_rate == 50.0
    expected = np.stack([walk[role] for role in names.values()], axis=1)
    assert_allclose(tracks.positions, expected, atol=1e-4)


def test_it_is_said_that_they_are_no_complete_body(make_reader, walk, collected_messages):
    messages, progress = collected_messages

    make_reader("take.csv")(table(LEG, walk), progress=progress)

    assert any("a few joints of a body" in str(message) for message in messages)


LIMBS = {
    "shoulder": "UpperArm", "elbow": "LowerArm", "wrist": "Hand",
    "hip": "UpperLeg", "knee": "LowerLeg", "ankle": "Foot",
}  # fmt: skip


@pytest.mark.parametrize("prefix", ["", "body_", "kp."])
def test_limbs_without_a_head_stand(read_any, walk, prefix):
    """No joint above the hips shows which way is up, but the feet do."""
    names = {f"{prefix}{side}_{part}": side + role
             for side in ("left", "right") for part, role in LIMBS.items()}  # fmt: skip

    recording = read_any(table(names, walk))

    found = [recording.names.index(name.removeprefix(prefix)) for name in names]
    expected = np.stack([walk[role] for role in names.values()], axis=1)
    assert_allclose(recording.tracks.positions[:, found], expected, atol=1e-4)


def test_landmarks_may_have_hands_next_to_them(read_any, walk, rng):
    """freemocap calls them body_ and right_hand_; before, all were markers."""
    points = {f"body_{name}": walk["head"] for name in BODY_POINTS}
    for side in ("left", "right"):
        points |= {f"body_{side}_{part}": walk[side + role] for part, role in LIMBS.items()}
        points[f"body_{side}_foot_index"] = walk[f"{side}Toes"]
    hands = {f"right_hand_{k:04d}": walk["rightHand"] + rng.normal(size=3) for k in range(21)}
    points |= hands

    recording = read_any(table({name: name for name in points}, points))

    knee = recording.tracks.positions[:, recording.names.index("left_knee")]
    assert_allclose(knee, walk["leftLowerLeg"], atol=1e-4)


@pytest.mark.parametrize("names", [{"a": "hips", "b": "head", "c": "leftFoot"},
                                   {"head": "head", "hips": "hips"}])  # fmt: skip
def test_a_few_points_without_names_of_joints_are_refused(read_any, walk, names):
    with pytest.raises(InvalidFileError, match="too few points for a body"):
        read_any(table(names, walk))
