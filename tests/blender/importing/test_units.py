"""The unit of files: guessed from the size of the body and reported, or chosen."""

import numpy as np
import pytest
from kinect_walks import tracked_walk, true_positions
from modal_events import wait

SAID = "Lengths are interpreted as millimeters, by the size of the body; give the unit"


@pytest.fixture
def silent(load, tmp_path):
    """A walk of a Kinect in millimeters, in a file that does not say so."""
    motion = load("solvers.motion")
    truth = true_positions(
        load("solvers.samples"), load("solvers.motion.humanoid.posture_joints")
    )
    walk = tracked_walk(motion, 1000.0 * truth, noise=5.0)
    path = tmp_path / "walk.csv"
    load("solvers.recordings").write_joint_csv(walk, path)
    path.write_text(path.read_text().replace("units=m,", "", 1))
    return path


def height(armature):
    """Meters from the lowest to the highest joint, at rest."""
    heads = np.array([bone.head_local for bone in armature.data.bones])
    return np.ptp(heads[:, 2])


@pytest.mark.parametrize(
    ("unit", "size"),
    [("GUESS", 1.0), ("MILLIMETRES", 1.0), ("CENTIMETRES", 10.0), ("METRES", 1000.0)],
)
def test_a_chosen_unit_is_used_and_a_guess_is_reported(bring, silent, capfd, unit, size):
    armature = bring(silent, unit=unit)

    assert 1.2 * size < height(armature) < 2.0 * size
    assert (SAID in capfd.readouterr().out) == (unit == "GUESS")


def test_redo_panel_reads_the_file_again_in_another_unit(bring, silent):
    first = height(bring(silent, unit="GUESS"))
    second = height(bring(silent, unit="METRES"))
    third = height(bring(silent, unit="GUESS"))

    assert second == pytest.approx(1000.0 * first, rel=1e-4)
    assert third == pytest.approx(first, rel=1e-6)


def test_it_counts_for_every_format(bring, recordings):
    path = recordings / "mocap" / "cmu_walk" / "07_01.bvh"

    one, other = height(bring(path, unit="MILLIMETRES")), height(bring(path, unit="METRES"))

    assert other == pytest.approx(1000.0 * one, rel=1e-4)


def test_dialog_reports_estimates(load, silent, blank):
    preview = load("mocap_assist.importing.importing").preview

    assert SAID in preview(blank.context, [silent])


def test_a_window_reports_the_guess_and_reads_in_the_chosen_unit(
    press, window, walks, silent, load, blank
):
    units = load("solvers.recordings").Unit
    for unit, n_messages in ((units.GUESS, 1), (units.METRES, 0)):
        operator = press(silent.name, unit=unit)
        assert wait(operator, window) == {"FINISHED"}
        assert window.reports[-1][1].count(SAID) == n_messages
        size = 1.0 if n_messages else 1000.0
        assert 1.2 * size < height(blank.context.object) < 2.0 * size


def test_the_command_line_takes_it_too(load, silent, blank, tmp_path, capsys):
    run = load("mocap_assist.batch.command").run
    blend = tmp_path / "walk.blend"
    blank.ops.wm.save_as_mainfile(filepath=str(blend))

    assert run(["import", str(silent), "--unit", "centimetres"]) == 0
    assert SAID not in capsys.readouterr().out
    assert height(blank.context.object) > 12.0
