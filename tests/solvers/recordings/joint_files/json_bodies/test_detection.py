"""JSON is recognized by the names of joints in it."""

import json

import pytest

from solvers.recordings import detect_format


@pytest.mark.parametrize("content", [
    {"legend": [1, 2, 3]}, {"handles": [[1, 2, 3]]}, {"headers": {"x": 1}},
    {"alarm": [1, 2, 3]}, {"ship": [1, 2, 3]}, {"hand": [1, 2]}, {"spine": 3},
])  # fmt: skip
def test_words_that_contain_a_joint_are_no_joints(tmp_path, content):
    assert detect_format(write(tmp_path / "take.json", content)) is None


@pytest.mark.parametrize("name", [
    "hips_joint", "left_upLeg_joint", "LeftForeArm", "mixamorig:LeftUpLeg", "upperarm_l",
    "spine_01", "lhip", "RKnee", "SpineBase", "headtop", "LOWER_LEG", "Bip01 L Foot", "PELVIS",
])  # fmt: skip
def test_names_of_joints_are_found(tmp_path, name):
    for value in ([0.1, 1, -2e-3], [None, [1, 2, 3]], {"X": 1}, {"pos": {"x": 1.0}}):
        found = detect_format(write(tmp_path / "take.json", {name: value}))
        assert found is not None and found.name == "JSON of joints"


@pytest.mark.parametrize("content", [
    [[[1, 2, 3]]], {"fps": 60, "array": [[[1, 2, 3]]]}, {"coordinates": [[[1, 2, 3]]]},
])  # fmt: skip
def test_arrays_are_found(tmp_path, content):
    found = detect_format(write(tmp_path / "take.json", content))
    assert found is not None and found.name == "JSON of joints"


@pytest.mark.parametrize("text", [
    "a,[[[1,2,3]]]\n", '"a",[[[1,2,3]]]\n', "name = [[[1, 2]]]",
    '{"type": "Polygon", "coordinates": [[[7.5, 47.5], [7.6, 47.6]]]}',
    '{"bbox": null, "type": "MultiPolygon", "coordinates": [[[[7.5, 47.5]]]]}',
])  # fmt: skip
def test_other_nested_brackets_are_no_joints(tmp_path, text):
    path = tmp_path / "take.csv"
    path.write_text(text)
    assert detect_format(path) is None


def write(path, content):
    path.write_text(json.dumps(content))
    return path
