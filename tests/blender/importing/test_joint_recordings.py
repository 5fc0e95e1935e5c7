"""Joints of depth cameras become armatures that keep gaps, and what the sensor said."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

TOLERANCE_M = 1e-5  # meters; bones and keys are 32-bit numbers
MAX_MISS_M = 0.06  # meters that a bone of constant length may miss a joint by


@pytest.fixture
def lossy(recordings):
    """A take of 44 frames in which hands and feet are lost for a while."""
    return recordings / "kinect" / "irds" / "215_18_5_8_1_stand.txt"


def test_bones_follow_the_joints(lossy, bring, load, poses):
    recording = load("solvers.recordings").read_recording(lossy)

    armature = bring(lossy, frame_rate="ONE", place_on_floor="NEVER")

    shown = poses(armature, range(1, recording.n_frames + 1))
    misses = [
        np.linalg.norm(shown[name][:, :3, 3] - recording.tracks.positions[:, joint], axis=-1)
        for joint, name in enumerate(recording.names)
        if name in shown
    ]
    assert len(misses) >= 20
    assert np.nanmedian(misses) < 0.01
    assert np.nanpercentile(misses, 95) < MAX_MISS_M


@pytest.mark.parametrize("fps", [24, 30, 120])
def test_what_was_not_tracked_has_no_keys(fps, lossy, bring, load, blank):
    blank.context.scene.render.fps = fps
    motion = load("solvers.motion")
    recording = load("solvers.recordings").read_recording(lossy)
    expected = motion.motion_from_points(recording.tracks, recording.parents)
    assert not expected.observed.all()

    armature = bring(lossy, frame_rate="SCALE", place_on_floor="NEVER")

    take = load("mocap_assist.actions.armature_read").read_take(armature, blank.context.scene)
    read = take.parts[0].motion
    assert read.frame_rate == pytest.approx(30.0)
    assert sorted(read.skeleton.names) == sorted(expected.skeleton.names)
    for joint, name in enumerate(expected.skeleton.names):
        assert_array_equal(
            read.observed[:, read.skeleton.index(name)], expected.observed[:, joint], name
        )
    where = motion.forward_kinematics
    order = [read.skeleton.index(name) for name in expected.skeleton.names]
    assert_allclose(
        where(read).positions[:, order], where(expected).positions, atol=TOLERANCE_M
    )


@pytest.mark.parametrize("target", ["ARMATURE", "OBJECT"])
def test_confidence_is_kept_and_survives_cleaning(
    lossy, bring, load, target, blank, markers_of
):
    recording = load("solvers.recordings").read_recording(lossy)

    made = bring(lossy, target=target, frame_rate="ONE", place_on_floor="NEVER")
    if target == "ARMATURE":
        assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}
        owners = {bone.name: bone for bone in made.pose.bones}
        assert made.animation_data.action.name.endswith(".clean")
    else:
        owners = {empty["mocap_assist_point"]: empty for empty in markers_of(made)}

    states = np.zeros((recording.n_frames, len(owners)))
    for frame in range(recording.n_frames):
        blank.context.scene.frame_set(frame + 1)
        states[frame] = [owner["mocap_tracking_state"] for owner in owners.values()]
    order = [recording.names.index(name) for name in owners]
    assert_array_equal(states, recording.tracking_state[:, order])
    assert (states == 0).any()


def test_empties_give_back_what_the_camera_measured(lossy, bring, load, blank):
    recording = load("solvers.recordings").read_recording(lossy)
    read = load("mocap_assist.actions.markers.take").read_markers

    empties = bring(lossy, target="OBJECT", place_on_floor="NEVER")
    tracks = read(empties, blank.context.scene).tracks

    order = [recording.names.index(name) for name in tracks.names]
    assert len(order) == recording.n_joints
    assert_allclose(tracks.positions, recording.tracks.positions[:, order], atol=TOLERANCE_M)


@pytest.mark.parametrize("target", ["ARMATURE", "OBJECT"])
def test_the_file_and_the_sensor_are_noted(target, lossy, bring, load, markers_of):
    origin = load("mocap_assist.scene.origin")

    made = bring(lossy, target=target)

    player = made if target == "ARMATURE" else markers_of(made)[0]
    for owner in (made, player.animation_data.action):
        noted = origin.origin_of(owner)
        assert noted["file"].endswith(lossy.name)
        assert (noted["sensor"], noted["frame_rate"]) == ("kinect_v2", 30.0)


@pytest.fixture
def kinect(load, rng):
    """A short recording of all joints of a Kinect v2 that wander about."""
    motion = load("solvers.motion")
    names = motion.SENSOR_JOINTS[motion.Sensor.KINECT_V2]
    positions = rng.normal(size=(1, 25, 3)) + np.cumsum(
        rng.normal(scale=0.01, size=(40, 25, 3)), 0
    )
    tracks = motion.Tracks(names, positions, 30.0, rng.uniform(size=(40, 25)))
    state = rng.integers(0, 3, size=(40, 25))
    return motion.JointRecording(tracks, state, motion.Sensor.KINECT_V2)


@pytest.mark.parametrize("extension", [".csv", ".json"])
def test_our_own_tables_of_joints_become_armatures(extension, kinect, bring, load, tmp_path):
    path = tmp_path / f"joints{extension}"
    load("solvers.recordings").write_joints(kinect, path)
    again = load("solvers.recordings").read_recording(path)

    armature = bring(path, frame_rate="ONE")

    assert set(armature.pose.bones.keys()) == set(kinect.names)
    channels = armature.animation_data.action.layers[0].strips[0].channelbags[0].fcurves
    for joint, name in enumerate(kinect.names):
        curve = channels.find(f'pose.bones["{name}"]["mocap_confidence"]')
        values = [curve.evaluate(frame) for frame in range(1, 41)]
        assert_allclose(values, again.tracks.confidence[:, joint], atol=1e-6)


def test_joints_without_parents_become_empties_with_a_message(
    kinect, bring, load, tmp_path, capfd
):
    motion, path = load("solvers.motion"), tmp_path / "three.json"
    tracks = motion.Tracks(("a", "b", "c"), kinect.tracks.positions[:, :3], 30.0)
    unknown = motion.JointRecording(tracks, None, motion.Sensor.OTHER)
    load("solvers.recordings").write_joints(unknown, path)

    holder = bring(path)

    assert holder.type == "EMPTY"
    assert len(holder.children) == 3
    assert "the parents of the joints are unknown" in capfd.readouterr().out


@pytest.mark.parametrize(("n_points", "n_loose"), [(33, 0), (75, 2), (553, 480)])
def test_a_body_of_freemocap_becomes_an_armature(
    n_points, n_loose, bring, rng, load, tmp_path, capfd
):
    path = tmp_path / "skeleton_3d.npy"
    body = load("solvers.motion.skeletons.mediapipe").BODY_POINTS
    points = rng.normal(scale=20.0, size=(50, n_points, 3))
    points[:, body.index("nose"), 2] += 1600.0
    for height, joint in enumerate(("ankle", "knee", "hip", "shoulder", "ear")):
        for place, side in ((200.0, "left"), (-200.0, "right")):
            points[:, body.index(f"{side}_{joint}")] += (place, 0.0, 400.0 * height)
    np.save(path, points)

    armature = bring(path)

    assert armature.type == "ARMATURE"
    names = set(armature.data.bones.keys())
    assert {"hips_center", "left_elbow", "right_knee", "left_foot_index"} <= names
    assert ("left_hand_index_3" in names) == (n_points > 33)
    assert not any(name.startswith("face_") for name in names)
    message = capfd.readouterr().out
    assert (f"without {n_loose} points that have no joint" in message) == (n_loose > 0)


def test_points_of_freemocap_that_are_no_body_become_empties(bring, rng, tmp_path):
    path = tmp_path / "skeleton_3d.npy"
    np.save(path, 1000.0 * rng.uniform(size=(50, 21, 3)))

    assert len(bring(path).children) == 21


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


def test_never_observed_joints_are_reported_and_others_stay(lossy, load, tmp_path, blank):
    recordings = load("solvers.recordings")
    recording = recordings.read_recording(lossy)
    positions = recording.tracks.positions.copy()
    positions[:, recording.names.index("SpineMid")] = np.nan
    recordings.write_joints(
        recording.with_tracks(recording.tracks.with_positions(positions)), tmp_path / "lost.csv"
    )
    files = load("mocap_assist.importing.importing")
    choices = load("mocap_assist.importing.button_settings").ImportChoices()

    imported = files.import_files(blank.context, [tmp_path / "lost.csv"], choices)

    assert "Left out, since never observed: SpineMid." in imported.sentence
    bones = set(imported.made[0].data.bones.keys())
    assert {"Head", "WristLeft", "KneeRight"} <= bones
    assert "SpineMid" not in bones
