"""`blender FILE --command mocap_assist reconstruct`."""

import json

import pytest


@pytest.fixture
def run(load, tmp_path, blank):
    """Do what a command line says, in this Blender; return status and output."""

    def command(*words):
        return load("mocap_assist.batch.command").run([str(word) for word in words])

    return command


def test_reconstruct_command_writes_actions_and_saves(walk, run, tmp_path, blank, capsys):
    blank.ops.wm.save_as_mainfile(filepath=str(tmp_path / "walk.blend"))

    status = run("reconstruct", "--no-plant-feet", "--json")

    assert status == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if line[:1] == "{"]
    result = json.loads(lines[-1])
    assert result["armature"] == "walk" and result["action"] == "walk.reconstructed"
    assert result["operation"] == "reconstruct" and result["settings"]["plant_feet"] is False
    blank.ops.wm.open_mainfile(filepath=str(tmp_path / "walk.blend"))
    assert "walk.reconstructed" in blank.data.actions


def test_reconstruct_command_reports_errors_in_one_sentence(blank, run, capsys):
    assert run("reconstruct") == 2
    assert capsys.readouterr().err.strip() == "The scene has no animated armature."
