"""The button Import, on real files."""

import contextlib
import io

import numpy as np
import pytest
from numpy.testing import assert_allclose

# Blender's importer leaves its file open.
INCH = 0.0254 / 0.45  # CMU's unit, in meters
TOLERANCE_M = 1e-5  # meters; bones and keys are 32-bit numbers


@pytest.mark.parametrize("file", ["cmu_walk/07_01.bvh", "05_13.amc"])
def test_armature_moves_as_in_the_file(file, recordings, bring, load, blank):
    path = recordings / "mocap" / file
    recorded = load("solvers.recordings").read_recording(path)

    armature = bring(path)

    take = load("mocap_assist.actions.armature_read").read_take(armature, blank.context.scene)
    read = take.parts[0].motion
    assert sorted(read.skeleton.names) == sorted(recorded.skeleton.names)
    assert read.n_frames == recorded.n_frames
    assert read.frame_rate == pytest.approx(recorded.frame_rate)
    where = load("solvers.motion").forward_kinematics
    order = [read.skeleton.names.index(name) for name in recorded.skeleton.names]
    assert_allclose(
        where(read).positions[:, order], where(recorded).positions, atol=TOLERANCE_M
    )
    parents = [read.skeleton.names[read.skeleton.parents[joint]] for joint in order[1:]]
    names = recorded.skeleton.names
    assert parents == [names[parent] for parent in recorded.skeleton.parents[1:]]
    assert np.isfinite(read.rotations).all()


def test_bones_are_where_blenders_own_importer_puts_them(recordings, bring, poses, blank):
    path = recordings / "mocap" / "cmu_walk" / "07_01.bvh"
    with contextlib.redirect_stdout(io.StringIO()):
        blank.ops.import_anim.bvh(filepath=str(path), global_scale=INCH)
    theirs = poses(blank.context.object, range(1, 317, 45))

    ours = poses(bring(path, frame_rate="ONE"), range(1, 317, 45))

    assert ours.keys() == theirs.keys()
    for name, matrices in ours.items():
        assert_allclose(matrices[:, :3, 3], theirs[name][:, :3, 3], atol=5 * TOLERANCE_M)


@pytest.mark.parametrize("file", ["c3d/DEC_INT.C3D", "trc/motion_capture_run.trc"])
def test_markers_become_empties_with_gaps(file, recordings, bring, load, blank):
    path = recordings / "formats" / file
    recorded = load("solvers.recordings").read_recording(path)
    visible = [
        name for name, ever in zip(recorded.names, recorded.visible.any(0), strict=True) if ever
    ]
    assert not recorded.visible.all()

    holder = bring(path, frame_rate="ONE")

    below = [each for each in holder.children_recursive if "mocap_assist_point" in each]
    markers = {each["mocap_assist_point"]: each for each in below}
    assert set(markers) == set(visible)
    assert len({each.animation_data.action for each in holder.children if each in below}) == 1
    for layer in blank.context.view_layer.layer_collection.children:  # of computed points
        layer.hide_viewport = False
    for frame in range(0, recorded.n_frames, 11):
        blank.context.scene.frame_set(frame + 1)
        for point, name in enumerate(recorded.names):
            if recorded.visible[frame, point]:
                shown = markers[name].matrix_world.translation
                assert_allclose(shown, recorded.positions[frame, point], atol=TOLERANCE_M)
    for name in visible:
        point = recorded.names.index(name)
        bag = channelbag(markers[name])
        counts = [
            len(curve.keyframe_points) for curve in bag.fcurves if "loc" in curve.data_path
        ]
        assert counts == 3 * [int(recorded.visible[:, point].sum())]


def test_a_walk_is_cleaned_after_it_was_imported(recordings, bring, blank):
    armature = bring(recordings / "mocap" / "cmu_walk" / "07_01.bvh")
    assert (blank.context.scene.render.fps, blank.context.scene.frame_end) == (120, 317)

    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}

    assert armature.animation_data.action.name == "07_01.clean"


def test_odd_names_and_bones_without_length_are_no_obstacle(bring, load, blank, tmp_path):
    motion = load("solvers.motion")
    names = (
        'Hip "left"',
        "hip.L",
        "Спина",
        "a" * 70,
        "a" * 69 + "b",
        "lone",
        "lone_end",
        "x_end",
    )
    parents = (-1, 0, 1, 1, 1, 0, 5, 0)
    offsets = np.array([
        [0, 0, 1.0], [0, 0, 0], [0, 0, 0.3], [0.2, 0, 0], [-0.2, 0, 0],
        [0, 0, -0.5], [0, 0, 0], [0, 0.1, 0],
    ])  # fmt: skip
    skeleton = motion.Skeleton(names, parents, offsets)
    rotations = load("solvers.rotations.representations").quaternion_from_rotation_vector(
        0.3 * np.sin(np.arange(20 * 8 * 3.0)).reshape(20, 8, 3)
    )
    rotations[:, 6:] = (1.0, 0.0, 0.0, 0.0)
    dance = motion.Motion(skeleton, rotations, np.ones((20, 3)) * np.arange(20)[:, None], 24.0)
    make = load("mocap_assist.importing.recording_objects").make_objects
    choices = load("mocap_assist.importing.button_settings").ImportChoices()

    armature = make(blank.context, "odd", dance, choices).top

    take = load("mocap_assist.actions.armature_read").read_take(armature, blank.context.scene)
    read = motion.forward_kinematics(take.parts[0].motion).positions
    expected = motion.forward_kinematics(dance).positions
    assert read.shape == expected.shape
    for point in np.moveaxis(expected, 1, 0):
        nearest = np.abs(read - point[:, None]).max(axis=(0, 2)).min()
        assert nearest < 10 * TOLERANCE_M


def channelbag(animated):
    action, slot = animated.animation_data.action, animated.animation_data.action_slot
    return action.layers[0].strips[0].channelbag(slot)


def test_names_longer_than_blender_can_hold_are_cut_between_letters(bring, load, tmp_path):
    samples = load("solvers.samples")
    walk = samples.walking_gait(samples.GaitSettings(duration=0.5, frame_rate=30.0))
    file = tmp_path / f"{'Ж' * 40}.bvh"
    load("solvers.recordings").write_bvh(walk, file)
    file.write_text(file.read_text().replace("LeftArm", "Ж" * 50).replace("RightArm", "Ж" * 51))

    armature = bring(file)

    assert armature.name == "Ж" * 31
    assert {"Ж" * 31, "LeftForeArm"} <= set(armature.data.bones.keys())
    assert len(armature.data.bones) == len([
        name for name in walk.skeleton.names if not name.endswith("_end")
    ])
