"""`blender --command mocap_assist capture`: from depth to a .blend with an armature."""

import json

import numpy as np
import pytest
from depth_folders import open3d

FAST_OPTIONS = ["--no-backward", "--no-refine", "--no-plant-feet"]


def test_capture_command_makes_armatures_and_names_failed_takes(
    truth, blank, load, tmp_path, capsys
):
    run = load("mocap_assist.batch.command").run
    good, wrong, target = (tmp_path / name for name in ("walk.npz", "no.npz", "out.blend"))
    np.savez_compressed(good, **truth)
    wrong.write_bytes(b"nothing")
    words = ["capture", str(good), str(wrong), "--output", str(target), *FAST_OPTIONS]

    status = run([*words, "--json", str(tmp_path / "report.json")])

    report = json.loads((tmp_path / "report.json").read_text())
    message = capsys.readouterr()
    assert status == 2 and "no.npz" in message.err
    assert report["objects"] == ["walk tracked"] and len(report["failed"]) == 1
    blank.ops.wm.open_mainfile(filepath=str(target))
    armature = blank.data.objects["walk tracked"]
    assert armature.animation_data.action is not None


@pytest.fixture
def takes(truth, load, tmp_path):
    """A folder of two takes of depth, one of them a folder of pictures, and a walk."""
    folder = tmp_path / "takes"
    (folder / "first").mkdir(parents=True)
    np.savez_compressed(folder / "first" / "walk.npz", **truth)
    lens = tuple(float(truth[name]) for name in ("fx", "fy", "cx", "cy"))
    open3d(folder / "second", truth["depth"], lens)
    samples = load("solvers.samples")
    gait = samples.walking_gait(samples.GaitSettings(duration=1.0, frame_rate=30.0))
    load("solvers.recordings").write_bvh(gait, folder / "gait.bvh")
    return folder


def test_a_folder_of_takes_is_imported(takes, blank, load, tmp_path):
    run = load("mocap_assist.batch.command").run
    target = tmp_path / "all.blend"

    assert run(["import", str(takes), "--output", str(target)]) == 0

    blank.ops.wm.open_mainfile(filepath=str(target))
    names = {each.name for each in blank.data.objects}
    assert {"walk", "second", "gait"} <= names
    assert blank.data.objects["gait"].type == "ARMATURE"
    assert blank.data.objects["second"].type == blank.data.objects["walk"].type == "MESH"


def test_a_folder_of_takes_is_captured(takes, blank, load, tmp_path, capsys):
    run = load("mocap_assist.batch.command").run
    out = tmp_path / "out"

    status = run([
        "each",
        str(takes),
        "--output-folder",
        str(out),
        "--",
        "capture",
        *FAST_OPTIONS,
    ])

    assert status == 0, capsys.readouterr().err
    made = {path.relative_to(out).as_posix() for path in out.rglob("*.blend")}
    assert made == {"first/walk.blend", "second.blend"}
    blank.ops.wm.open_mainfile(filepath=str(out / "second.blend"))
    assert blank.data.objects["second tracked"].animation_data.action is not None

    empty = tmp_path / "empty"
    empty.mkdir()
    assert (
        run(["capture", str(empty), "--output", str(tmp_path / "no.blend"), *FAST_OPTIONS]) == 2
    )
    assert "There is no recording in the folder" in capsys.readouterr().err


def test_a_folder_of_takes_becomes_one_scene(takes, blank, load, tmp_path, capsys):
    run = load("mocap_assist.batch.command").run
    target = tmp_path / "both.blend"

    status = run(["capture", str(takes), "--output", str(target), *FAST_OPTIONS])

    assert status == 0, capsys.readouterr().err
    blank.ops.wm.open_mainfile(filepath=str(target))
    assert {"walk tracked", "second tracked"} <= {each.name for each in blank.data.objects}
