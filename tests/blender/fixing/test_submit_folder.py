"""Submit Folder: a farm fixes the takes of a folder, and the scene stays as it is."""

import json
from pathlib import Path

import bpy
import pytest
from clusters.flamenco_stub import JOB_ID, JOBS, TYPE, VERSION, flamenco_stub
from modal_events import event, wait

OFFLINE = "Blender's online access is off. Allow it in Preferences > System to submit jobs"


@pytest.fixture
def manager(load):
    """A Flamenco Manager that the preferences name, and Blender may reach."""
    system = bpy.context.preferences.system
    with flamenco_stub() as stub:
        preferences = load("mocap_assist.panel_parts.preference_values").preferences()
        preferences.flamenco_manager = stub.address
        preferences.flamenco_command = "mocap-assist"
        system.use_online_access = True
        yield stub
        system.use_online_access = False
        bpy.ops.mocap_assist.reset_preferences()


@pytest.fixture
def folder(load, tmp_path):
    """Two takes of one name in a folder, and one below it."""
    samples, recordings = load("solvers.samples"), load("solvers.recordings")
    walk = samples.walking_gait(samples.GaitSettings(duration=0.2, frame_rate=30.0))
    (tmp_path / "shoot" / "day2").mkdir(parents=True)
    for name in ("a.bvh", "day2/b.bvh"):
        recordings.write_bvh(walk, tmp_path / "shoot" / name)
    (tmp_path / "shoot" / "a.asf").write_bytes((tmp_path / "shoot" / "a.bvh").read_bytes())
    return tmp_path / "shoot"


@pytest.fixture
def press(make_button, manager, folder, window, load):
    """Press the button for the folder in the window, and return it: it waits."""

    def pressed():
        bundle = load("mocap_assist.farm.button_settings").FarmBundle
        fixing = load("solvers.workflows").FixSettings()
        settings = bundle(load("solvers.command_line.farm").FlamencoSettings(), fixing)
        button = make_button("submit_folder", settings)
        button.directory, button.output_folder, button.is_chosen = str(folder), "", True
        assert button.invoke(window.context, None) == {"RUNNING_MODAL"}
        return button

    return pressed


@pytest.fixture
def why_gray(load, window):
    """Return why the button is gray, or an empty text."""
    module = load("mocap_assist.farm.submitting")
    return lambda: module.why_not_submit(window.context)


def test_folder_is_submitted_as_a_job(blank, manager, folder):
    status = blank.ops.mocap_assist.submit_folder(
        directory=str(folder), flamenco_tasks=3, physics=True
    )

    assert status == {"FINISHED"}
    out = folder.with_name("shoot_fixed")
    (takes,) = out.iterdir()
    assert [json.loads(line) for line in takes.read_text().splitlines()] == [
        {"input": str(folder / "a.asf"), "output": "a.asf.bvh"},
        {"input": str(folder / "a.bvh"), "output": "a.bvh.bvh"},
        {"input": str(folder / "day2" / "b.bvh"), "output": "day2/b.bvh"},
    ]
    (_, path, body) = manager.requests[-1]
    assert (path, body["name"], body["type"]) == (JOBS, "fix shoot", "mocap-assist-fix")
    assert {name: value for name, value in body["settings"].items() if value != ""} == {
        "manifest": str(takes),
        "output_folder": str(out),
        "shards": 3,
        "command": "mocap-assist",
        "physics": "yes",
        "plant_feet": "yes",
    }
    assert not blank.data.objects


def test_window_goes_on_until_the_manager_answers(press, manager, folder, window):
    (folder / "day2" / "c.fbx").write_bytes(b"Kaydara FBX Binary")
    (folder / "d.usda").write_text("#usda 1.0")
    button = press()
    status = wait(button, window)

    page = f"{manager.address}/app/jobs/{JOB_ID}"
    message = (
        f"Submitted 3 takes of shoot to {page}. 2 files need Blender and were left out."
        " Move them to another folder and press Fix Folder there."
    )
    assert (status, window.reports) == ({"FINISHED"}, [({"INFO"}, message)])


def test_failure_of_the_manager_is_reported(blank, manager, folder):
    """And nothing is written."""
    manager.changed[TYPE] = manager.answer("/api/v3/jobs/type/unknown")

    with pytest.raises(RuntimeError, match=r"no job type mocap-assist-fix\. Copy .*_fix\.js"):
        blank.ops.mocap_assist.submit_folder(directory=str(folder))

    assert not folder.with_name("shoot_fixed").exists()


def test_folder_of_files_that_need_blender_names_the_way(blank, manager, folder):
    for path in [*folder.rglob("*.bvh"), folder / "a.asf"]:
        path.with_suffix(".fbx").write_bytes(b"Kaydara FBX Binary")
        path.unlink()

    with pytest.raises(RuntimeError, match=r"such as a\.fbx, press Fix Folder in Blender, or"):
        blank.ops.mocap_assist.submit_folder(directory=str(folder))

    assert not manager.requests


def test_cancelled_job_that_was_sent_is_not_taken_back(press, manager, window):
    manager.changed = {TYPE: manager.answer(f"{TYPE}mocap-assist-fix"), JOBS: None}
    button = press()
    assert wait(button, window, lambda: manager.requests[2:]) is None

    assert button.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}
    ((_, message),) = window.reports
    assert "Look at the Manager's list of jobs before you submit it again" in message


def test_cancelled_job_that_was_not_sent(press, manager, window, load, monkeypatch):
    monkeypatch.setattr(load("mocap_assist.blender.time_slices"), "SHORT_WAIT_S", 0.0)
    manager.changed[VERSION] = None  # no answer
    button = press()
    assert wait(button, window, lambda: manager.requests) is None

    assert button.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}
    assert window.reports == [({"INFO"}, "Cancelled.")]
    assert window.status[0].startswith("Starting 0%")


@pytest.mark.parametrize("directory", ["", "/"])
def test_folder_without_a_name_needs_an_output_folder(blank, manager, directory):
    with pytest.raises(RuntimeError, match="Choose a folder of takes that has a name"):
        blank.ops.mocap_assist.submit_folder(directory=directory)

    assert not manager.requests


def test_paths_for_the_farm_are_absolute(blank, manager, folder, monkeypatch):
    monkeypatch.chdir(folder.parent)

    blank.ops.mocap_assist.submit_folder(directory="shoot", output_folder="fixed")

    settings = manager.requests[-1][2]["settings"]
    assert settings["output_folder"] == str(folder.with_name("fixed"))
    first = json.loads(Path(settings["manifest"]).read_text().splitlines()[0])
    assert first["input"] == str(folder / "a.asf")


def test_take_that_the_farm_cannot_retarget_is_refused(blank, manager, folder):
    blank.context.scene.mocap_assist.fix.rig = "Rig"

    with pytest.raises(RuntimeError, match="Clear Retarget To in Last Steps"):
        blank.ops.mocap_assist.submit_folder(directory=str(folder))

    assert not manager.requests and not folder.with_name("shoot_fixed").exists()


def test_button_is_gray_without_a_manager_or_online_access(
    blank, manager, folder, draw, load, why_gray
):
    blank.ops.mocap_assist.import_recording(filepath=str(folder / "a.bvh"))
    assert why_gray() == "" and "mocap_assist.submit_folder" in draw("MOCAP_PT_fix")
    bpy.context.preferences.system.use_online_access = False
    assert why_gray().startswith(OFFLINE)

    load("mocap_assist.panel_parts.preference_values").preferences().flamenco_manager = ""

    assert why_gray().startswith("Enter the address of your Flamenco Manager")
    assert "mocap_assist.submit_folder" not in draw("MOCAP_PT_fix")
    assert not blank.ops.mocap_assist.submit_folder.poll()
