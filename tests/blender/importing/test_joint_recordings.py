"""Joints of depth cameras become armatures that keep gaps, and what the sensor said."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

NEAR = 1e-5  # metres; bones and keys are 32-bit numbers
LARGEST = 0.06  # metres that a bone of constant length may miss a joint by


@pytest.fixture
def lossy(recordings):
    """A take of 44 frames in which hands and feet are lost for a while."""
    return recordings / "kinect" / "irds" / "215_18_5_8_1_stand.txt"


def test_bones_follow_the_joints(lossy, bring, load, poses):
    recording = load("solvers.recordings").read_recording(lossy)

    armature = bring(lossy, frame_rate="ONE")

    shown = poses(armature, range(1, recording.n_frames + 1))
    misses = [
        np.linalg.norm(shown[name][:, :3, 3] - recording.tracks.positions[:, joint], axis=-1)
        for joint, name in enumerate(recording.names)
        if name in shown
    ]
    assert len(misses) >= 20
    assert np.nanmedian(misses) < 0.01
    assert np.nanpercentile(misses, 95) < LARGEST


@pytest.mark.parametrize("fps", [24, 30, 120])
def test_what_was_not_tracked_has_no_keys(fps, lossy, bring, load, blank):
    blank.context.scene.render.fps = fps
    motion = load("solvers.motion")
    recording = load("solvers.recordings").read_recording(lossy)
    expected = motion.motion_from_points(recording.tracks, recording.parents)
    assert not expected.observed.all()

    armature = bring(lossy)

    take = load("mocap_assist.scene.armature_read").read_take(armature, blank.context.scene)
    read = take.parts[0].motion
    assert read.frame_rate == pytest.approx(30.0)
    assert sorted(read.skeleton.names) == sorted(expected.skeleton.names)
    for joint, name in enumerate(expected.skeleton.names):
        assert_array_equal(
            read.observed[:, read.skeleton.index(name)], expected.observed[:, joint], name
        )
    where = motion.forward_kinematics
    order = [read.skeleton.index(name) for name in expected.skeleton.names]
    assert_allclose(where(read).positions[:, order], where(expected).positions, atol=NEAR)


@pytest.mark.parametrize("target", ["ARMATURE", "OBJECT"])
def test_confidence_is_kept_and_survives_cleaning(lossy, bring, load, target, blank):
    recording = load("solvers.recordings").read_recording(lossy)

    made = bring(lossy, target=target, frame_rate="ONE")
    if target == "ARMATURE":
        assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}
        owners = {bone.name: bone for bone in made.pose.bones}
        assert made.animation_data.action.name.endswith(".clean")
    else:
        owners = {empty["mocap_assist_point"]: empty for empty in made.children}

    states = np.zeros((recording.n_frames, len(owners)))
    for frame in range(recording.n_frames):
        blank.context.scene.frame_set(frame + 1)
        states[frame] = [owner["mocap_tracking_state"] for owner in owners.values()]
    order = [recording.names.index(name) for name in owners]
    assert_array_equal(states, recording.tracking_state[:, order])
    assert (states == 0).any()


def test_the_file_and_the_sensor_are_noted(lossy, bring, load):
    origin = load("mocap_assist.scene.origin")

    armature = bring(lossy)

    for owner in (armature, armature.animation_data.action):
        noted = origin.origin_of(owner)
        assert noted["file"].endswith(lossy.name)
        assert (noted["sensor"], noted["frame_rate"]) == ("kinect_v2", 30.0)


@pytest.mark.parametrize(
    "file",
    [
        "msr_action3d/a02_s02_e02_skeleton3D.txt",
        "ui_prmd/m01_s01_e08.npz",
        "kimore/JointPositionExercise1.csv",
        "laban/Ges03_drawlines.csv",
        "azure/joints_sync_1.csv",
    ],
)
def test_joints_of_every_sensor_are_cleaned_with_the_button(file, recordings, bring, blank):
    armature = bring(recordings / "kinect" / file)

    assert armature.type == "ARMATURE"
    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}
    assert armature.animation_data.action.name.endswith(".clean")
