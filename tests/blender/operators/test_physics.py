"""Physics: a new action in which nothing sinks into the ground."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest


@pytest.fixture
def walker(blank, load, tmp_path):
    """A walk of a complete body, two seconds at 30 Hz, 10 cm below the ground."""
    samples, recordings = load("solvers.samples"), load("solvers.recordings")
    walk = samples.walking_gait(samples.GaitSettings(duration=2.0, frame_rate=30.0))
    sunk = walk.with_poses(root_positions=walk.root_positions - (0.0, 0.0, 0.1))
    recordings.write_bvh(sunk, tmp_path / "walk.bvh")
    blank.ops.mocap_assist.import_recording(filepath=str(tmp_path / "walk.bvh"))
    return blank.context.object


def test_the_result_is_a_new_action_on_the_ground(walker, blank, keys_of, load):
    raw = walker.animation_data.action
    before = keys_of(raw)

    assert blank.ops.mocap_assist.simulate() == {"FINISHED"}

    action = walker.animation_data.action
    assert action.name == "walk.physics" and keys_of(raw) == before
    entry = json.loads(action["mocap_assist_history"])[-1]
    assert entry["operation"] == "simulate" and entry["frames_not_followed"] == 0
    figures = entry["at_full_strength"]
    assert figures["penetration_before_cm"] > 8.0 and figures["penetration_after_cm"] < 1.0
    assert lowest_foot(walker, blank, load) > lowest_foot(walker, blank, load, raw) + 0.08
    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}
    assert walker.animation_data.action == raw


def test_partial_strength_needs_no_new_simulation(walker, blank, load, monkeypatch):
    assert blank.ops.mocap_assist.simulate() == {"FINISHED"}
    full = lowest_foot(walker, blank, load)
    blank.ops.mocap_assist.revert_to_raw()
    raw = lowest_foot(walker, blank, load)
    monkeypatch.setattr(load("mocap_assist.jobs.job"), "Job", None)

    assert blank.ops.mocap_assist.simulate(strength=0.5) == {"FINISHED"}

    half = lowest_foot(walker, blank, load)
    assert half == pytest.approx((full + raw) / 2, abs=0.02)


def test_ground_is_under_the_feet_on_request(walker, blank):
    assert blank.ops.mocap_assist.simulate(ground="FEET") == {"FINISHED"}

    action = walker.animation_data.action
    entry = json.loads(action["mocap_assist_history"])[-1]
    assert entry["settings"]["ground"] == "auto"
    assert -0.15 < entry["ground_m"] < -0.05


def test_unfollowable_take_is_reported_and_unchanged(walker, blank, keys_of, load):
    raw = walker.animation_data.action
    before = keys_of(raw)

    assert blank.ops.mocap_assist.simulate(ground="HEIGHT", ground_height=-20.0) == {"FINISHED"}

    action = walker.animation_data.action
    assert json.loads(action["mocap_assist_history"])[-1]["frames_not_followed"] == 60
    assert {name[1:]: keys for name, keys in keys_of(action).items()} == {
        name[1:]: keys for name, keys in before.items()
    }


def test_report_names_the_first_frame_of_the_action_that_was_not_followed(walker, blank, load):
    """Frames of the action, which starts at frame 1, not rows of an array."""
    simulating, scene = load("mocap_assist.physics.scene_simulating"), blank.context.scene
    settings = simulating.SimulateBundle(load("solvers.physics").SimulateSettings())
    solved = simulating.read_simulating(scene, walker, settings)()
    followed = solved.simulated.followed.copy()
    followed[5:8] = False
    partly = solved._replace(simulated=replace(solved.simulated, followed=followed))

    message = simulating.write_simulated(scene, walker, settings, partly)

    assert "The first frame that the body could not follow is 6." in message


def test_disabled_button_gives_a_reason(blank):
    assert not blank.ops.mocap_assist.simulate.poll()
    with pytest.raises(RuntimeError, match="Select an animated armature"):
        blank.ops.mocap_assist.simulate()


def test_engine_is_imported_from_the_wheels(extension, load):
    engine = load("solvers.physics.engine").load_engine()

    assert Path(engine.__file__).is_relative_to(Path(extension.__file__).parents[2] / ".local")


def test_physics_is_one_undo_step(blank):
    assert blank.types.MOCAP_ASSIST_OT_simulate.bl_options == {"REGISTER", "UNDO"}


def test_simulate_command_simulates_and_saves(walker, load, blank, capsys, tmp_path):
    target = tmp_path / "physics.blend"
    run = load("mocap_assist.batch.command").run

    status = run(["simulate", "--output", str(target), "--json", "--ground", "auto"])

    out, err = capsys.readouterr()
    assert (status, err) == (0, "")
    result = json.loads(next(line for line in out.splitlines() if line[:1] == "{"))
    assert (result["action"], result["settings"]["ground"]) == ("walk.physics", "auto")
    blank.ops.wm.open_mainfile(filepath=str(target))
    assert "walk.physics" in blank.data.actions


def lowest_foot(armature, blank, load, action=None):
    """Return the mean height of the lower foot over the take."""
    if action is not None:
        armature.animation_data.action, replaced = action, armature.animation_data.action
        height = lowest_foot(armature, blank, load)
        armature.animation_data.action = replaced
        return height
    read = load("mocap_assist.actions.armature_read").read_take
    source = load("mocap_assist.runtime.selection").played_source(armature)
    body = read(armature, blank.context.scene, source=source).parts[0].motion
    positions = load("solvers.motion").forward_kinematics(body).positions
    feet = [n for n, name in enumerate(body.skeleton.names) if "Foot" in name]
    return float(np.mean(positions[:, feet, 2].min(axis=1)))
