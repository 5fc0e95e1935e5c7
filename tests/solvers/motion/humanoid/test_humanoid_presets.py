"""Humanoid maps are saved and loaded; other files are refused in one sentence."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from solvers.errors import InvalidFileError
from solvers.motion import (
    HUMANOID_ROLES,
    HumanoidMap,
    find_humanoid_map,
    read_humanoid_map,
    write_humanoid_map,
)

HEAD = {"kind": "mocap_assist humanoid map", "version": 1}


def test_load_restores_a_saved_map(body, tmp_path):
    humanoid = find_humanoid_map(body).with_joint("head", None)

    write_humanoid_map(humanoid, tmp_path / "rig.json")

    assert read_humanoid_map(tmp_path / "rig.json", body).joints == humanoid.joints
    assert read_humanoid_map(tmp_path / "rig.json").score == 1.0
    assert [path.name for path in tmp_path.iterdir()] == ["rig.json"]


@given(
    st.dictionaries(st.sampled_from(HUMANOID_ROLES), st.text(min_size=1), max_size=6).filter(
        lambda joints: len(set(joints.values())) == len(joints)
    )
)
def test_load_restores_names_in_any_script(tmp_path_factory, joints):
    path = tmp_path_factory.mktemp("maps") / "rig.json"

    write_humanoid_map(HumanoidMap(joints), path)

    assert read_humanoid_map(path).joints == joints


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("{", "not a readable humanoid map"),
        ("[1, 2]", "is not a humanoid map"),
        ("[" * 100_000, "not a readable humanoid map"),
        (json.dumps({"joints": {"hips": "Hips"}}), "is not a humanoid map"),
        (json.dumps({**HEAD, "version": 2, "joints": {}}), "version 2"),
        (json.dumps({**HEAD, "joints": ["Hips"]}), "must name a joint"),
        (json.dumps({**HEAD, "joints": {"hips": 3}}), "must name a joint"),
        (json.dumps({**HEAD, "joints": {"tail": "Tail"}}), "not humanoid roles: tail"),
        (json.dumps({**HEAD, "joints": {"hips": "A", "head": "A"}}), "more than one has A"),
        (json.dumps({**HEAD, "joints": {"hips": "Pelvis"}}), "lacks: Pelvis"),
        (
            json.dumps({**HEAD, "joints": {"hips": "Hips"}})[:-2] + ', "hips": "Spine"}}',
            "contains hips more than once",
        ),
    ],
)
def test_load_names_the_fault_of_a_file(body, tmp_path, content, sentence):
    path = tmp_path / "rig.json"
    path.write_text(content, encoding="utf-8")

    with pytest.raises(InvalidFileError, match=sentence) as caught:
        read_humanoid_map(path, body)
    assert str(path) in str(caught.value)


def test_load_raises_for_missing_files_and_folders(tmp_path):
    with pytest.raises(InvalidFileError, match="There is no file"):
        read_humanoid_map(tmp_path / "none.json")
    with pytest.raises(InvalidFileError, match="not a readable"):
        read_humanoid_map(tmp_path)
    with pytest.raises(InvalidFileError, match="cannot be written"):
        write_humanoid_map(HumanoidMap(), tmp_path / "nowhere" / "rig.json")


def test_load_raises_for_binary_files(tmp_path):
    path = tmp_path / "rig.json"
    path.write_bytes(b"\xff\xfe\x00{")

    with pytest.raises(InvalidFileError, match="not a readable"):
        read_humanoid_map(path)
