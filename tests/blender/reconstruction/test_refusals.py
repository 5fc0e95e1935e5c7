"""Takes that cannot be reconstructed give one sentence, and nothing is written."""

import numpy as np
import pytest
from kinect_walks import tracked_walk


@pytest.fixture
def import_joints(load, bring, tmp_path):
    """Import joints that are given as names and positions."""

    def make(names, positions, **settings):
        motion = load("solvers.motion")
        tracks = motion.Tracks(tuple(names), positions, 30.0)
        recording = motion.JointRecording(tracks, None, motion.Sensor.OTHER)
        path = tmp_path / "take.csv"
        load("solvers.recordings").write_joint_csv(recording, path)
        return bring(path, **settings)

    return make


@pytest.fixture
def refused(blank):
    """Press Reconstruct and return the sentence; check that no action was added."""

    def press():
        actions = set(blank.data.actions)
        with pytest.raises(RuntimeError) as error:
            blank.ops.mocap_assist.reconstruct()
        assert set(blank.data.actions) == actions
        return str(error.value)

    return press


def test_armature_in_millimeters_is_accepted(load, truth, import_joints, blank):
    """Blender has no unit of its own: the size of the body shows it."""
    names = load("solvers.motion").SENSOR_JOINTS[load("solvers.motion").Sensor.KINECT_V1]
    armature = import_joints(names, truth, global_scale=1000.0)
    hips = armature.pose.bones["HipCenter"]

    assert blank.ops.mocap_assist.reconstruct() == {"FINISHED"}

    blank.context.scene.frame_set(30)
    assert np.allclose(hips.head, 1000.0 * truth[29, 0], atol=30.0)


def test_armature_that_fits_no_unit_is_refused(load, truth, import_joints, refused):
    names = load("solvers.motion").SENSOR_JOINTS[load("solvers.motion").Sensor.KINECT_V1]
    import_joints(names, truth, global_scale=1e-4)

    assert "Read the recording with a scale of" in refused()


def test_armature_without_a_body_is_refused(make_armature, animate, refused):
    bones = {"Door": (None, (0, 0, 0), (0, 0, 1), False),
             "Handle": ("Door", (0, 0, 1), (0, 0, 1.2), True)}  # fmt: skip
    animate(make_armature(bones))

    assert "no joint for hips" in refused()


def test_markers_are_refused(blank, load, tmp_path, rng):
    motion = load("solvers.motion")
    tracks = motion.Tracks(("A", "B"), rng.random((9, 2, 3)), 30.0)
    load("solvers.recordings").write_trc(tracks, tmp_path / "take.trc")
    blank.ops.mocap_assist.import_recording(filepath=str(tmp_path / "take.trc"))

    with pytest.raises(RuntimeError, match="Select an animated armature"):
        blank.ops.mocap_assist.reconstruct()


def test_missing_examples_are_reported(walk, blank):
    with pytest.raises(RuntimeError, match="Pick clean actions"):
        blank.ops.mocap_assist.reconstruct(postures="EXAMPLES")


def test_long_gap_is_reported_with_its_frames(load, truth, import_joints, blank, capfd):
    positions = np.array(tracked_walk(load("solvers.motion"), truth).tracks.positions)
    positions[20:60] = np.nan
    names = load("solvers.motion").SENSOR_JOINTS[load("solvers.motion").Sensor.KINECT_V1]
    armature = import_joints(names, positions)

    assert blank.ops.mocap_assist.reconstruct() == {"FINISHED"}

    assert "Nothing was tracked for 1.3 s" in capfd.readouterr().out
    assert armature.animation_data.action.name == "take.reconstructed"


def test_button_is_disabled_without_an_action(make_armature, blank):
    make_armature()

    with pytest.raises(RuntimeError, match="has no action"):
        blank.ops.mocap_assist.reconstruct()
