"""`retarget` and `unbake` of `blender FILE --command mocap_assist`."""

import json

import pytest


@pytest.fixture
def run_json(command):
    """Run the command; return its status, its lines of JSON, and what it complained about."""

    def call(*words):
        status, out, err = command(*words)
        lines = [json.loads(line) for line in out.splitlines() if line[:1] == "{"]
        return status, lines, err

    return call


def test_retarget_command_writes_actions_and_saves(walker, make_rig, blank, run_json, tmp_path):
    make_rig("Mixamo")
    saved = tmp_path / "hero.blend"

    for _ in range(2):  # the second time the target is animated too, and left alone
        status, lines, err = run_json(
            "retarget", "--target", "Mixamo", "--json", "--output", str(saved)
        )
        assert (status, err) == (0, "")
        assert [line["armature"] for line in lines] == [walker.name]
    assert lines[0]["operation"] == "retarget" and lines[0]["n_actions"] == 1

    blank.ops.wm.open_mainfile(filepath=str(saved))
    action = blank.data.objects["Mixamo"].animation_data.action
    assert action.name == lines[0]["action"]


def test_retarget_command_reduces_keys(walker, run_json, tmp_path):
    status, lines, err = run_json(
        "unbake", "--tolerance", "2", "--json", "--output", str(tmp_path / "few.blend")
    )

    assert (status, err) == (0, "")
    assert lines[0]["keys_after"] < 0.5 * lines[0]["keys_before"]
    assert lines[0]["error_cm"] <= 2.0
    assert lines[0]["settings"]["tolerance"] == 0.02


def test_retarget_command_reports_errors_in_one_sentence(walker, run_json, tmp_path):
    output = ("--output", str(tmp_path / "x.blend"))

    for words, sentence in (
        ((), "Choose the target armature."),
        (("--target", "Nobody"), "The scene has no armature Nobody."),
        (("--takes", "listed", "--target", walker.name), "is the source itself"),
    ):
        status, _, err = run_json("retarget", "--armature", walker.name, *words, *output)
        assert status == 2 and sentence in err
    assert not (tmp_path / "x.blend").exists()
