"""Armature actions become motions and come back: Blender's own evaluation is the judge."""

import numpy as np
import pytest
from mathutils import Euler, Matrix
from numpy.testing import assert_allclose

MODES = ["QUATERNION", "AXIS_ANGLE", "XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"]
TOLERANCE_M = 2e-5  # meters; poses are 32-bit numbers


@pytest.fixture
def rewrite(scene_io, blank):
    """Read a take, write it unchanged into a new action, and use that."""

    def again(armature, bones=None, take=None):
        take = take or scene_io.reading.read_take(armature, blank.context.scene)
        source = scene_io.reading.action_of(armature)
        chosen = take.rig.bones if bones is None else bones
        action, slot = scene_io.writing.write_take(armature, source, take, chosen, {})
        scene_io.writing.assign_result(armature, action, slot, scene_io.writing.Output.ACTION)
        return action

    return again


def joint_positions(scene_io, take):
    """Positions of the body's joints in the world, by bone."""
    body = take.parts[0]
    positions = scene_io.kinematics.forward_kinematics(body.motion).positions
    names = body.motion.skeleton.names
    return {name: positions[:, joint] for joint, name in enumerate(names)}


@pytest.mark.parametrize("mode", MODES)
def test_read_joints_equal_blenders_bones(mode, make_armature, animate, poses, scene_io):
    armature = make_armature(mode=mode)
    animate(armature)
    armature.matrix_world = (
        Matrix.Translation((1, 2, 3))
        @ Euler((0.3, 0.4, 0.5)).to_matrix().to_4x4()
        @ Matrix.Scale(2, 4)
    )
    frames = range(1, 61, 7)

    take = scene_io.reading.read_take(armature, armature.users_scene[0])

    found, shown = joint_positions(scene_io, take), poses(armature, frames)
    for bone, matrices in shown.items():
        assert_allclose(found[bone][::7], matrices[:, :3, 3], atol=TOLERANCE_M)
    ends = [matrix @ (0, np.linalg.norm((0.15, 0.08)), 0, 1) for matrix in shown["LeftFoot"]]
    assert_allclose(found["LeftFoot_end"][::7], np.array(ends)[:, :3], atol=TOLERANCE_M)


@pytest.mark.parametrize("mode", MODES)
def test_writing_the_read_motion_changes_nothing(mode, make_armature, animate, poses, rewrite):
    armature = make_armature(mode=mode)
    animate(armature, locations=True)
    before = poses(armature, range(1, 61))

    rewrite(armature)

    for bone, matrices in poses(armature, range(1, 61)).items():
        assert_allclose(matrices, before[bone], atol=TOLERANCE_M)


def test_moved_armature_is_read_in_world_space(
    make_armature, animate, poses, rewrite, scene_io
):
    armature = make_armature()
    animate(armature)
    for frame in range(1, 61):
        armature.location, armature.rotation_euler = (0.1 * frame, 0, 0), (0, 0, 0.05 * frame)
        for path in ("location", "rotation_euler"):
            armature.keyframe_insert(path, frame=frame)
    before = poses(armature, range(1, 61))

    take = scene_io.reading.read_take(armature, armature.users_scene[0])

    for bone, positions in joint_positions(scene_io, take).items():
        if not bone.endswith("_end"):
            assert_allclose(positions, before[bone][:, :3, 3], atol=TOLERANCE_M)
    rewrite(armature, take=take)
    for bone, matrices in poses(armature, range(1, 61)).items():
        assert_allclose(matrices, before[bone], atol=TOLERANCE_M)


def test_full_rotations_are_written_without_jumps(make_armature, animate, rewrite, blank):
    armature = make_armature(mode="ZXY")
    action = animate(armature)
    slot = armature.animation_data.action_slot
    path = 'pose.bones["Head"].rotation_euler'
    curves = action.layers[0].strips[0].channelbag(slot).fcurves
    for frame in range(60):  # five full rotations
        curves.find(path, index=2).keyframe_points[frame].co.y = frame * 10 * np.pi / 60

    clean = rewrite(armature)

    bag = clean.layers[0].strips[0].channelbag(armature.animation_data.action_slot)
    keys = np.array([key.co.y for key in bag.fcurves.find(path, index=2).keyframe_points])
    assert_allclose(keys[-1] - keys[0], 59 * 10 * np.pi / 60, atol=0.5)
    assert np.abs(np.diff(keys)).max() < 1.5


def test_connected_bones_ignore_their_location_and_keep_its_keys(
    make_armature, animate, rewrite, keys_of, scene_io
):
    armature = make_armature()
    action = animate(armature, locations=True)

    take = scene_io.reading.read_take(armature, armature.users_scene[0])

    assert set(take.offsets.names) == {
        "Head", "LeftArm", "RightArm", "LeftUpLeg", "RightUpLeg"
    }  # fmt: skip
    before, after = keys_of(action), keys_of(rewrite(armature))
    connected = [key for key in before if "LeftForeArm" in key[1] and "location" in key[1]]
    assert len(connected) == 3
    assert all(before[key] == after[key] for key in connected)


def test_only_chosen_bones_change_and_the_source_stays(
    make_armature, animate, keys_of, rewrite, scene_io
):
    armature = make_armature(mode="XYZ")
    action = animate(armature, locations=True)
    raw = keys_of(action)
    take = scene_io.reading.read_take(armature, armature.users_scene[0])
    motion = take.parts[0].motion
    other = take.with_recordings((motion.with_poses(motion.rotations[::-1]), take.offsets))

    clean = keys_of(rewrite(armature, bones=["Head"], take=other))

    assert keys_of(action) == raw
    changed = {
        path for (slot, path, index), keys in clean.items() if keys != raw[slot, path, index]
    }
    assert 'pose.bones["Head"].rotation_euler' in changed
    assert changed <= {'pose.bones["Head"].rotation_euler', 'pose.bones["Head"].location'}


def test_failed_write_leaves_no_action(
    make_armature, animate, rewrite, scene_io, blank, monkeypatch
):
    armature = make_armature(mode="QUATERNION")
    animate(armature)
    before = len(blank.data.actions)
    monkeypatch.setattr(scene_io.writing, "animated_curves", {}.__getitem__)

    with pytest.raises(TypeError):
        rewrite(armature)

    assert len(blank.data.actions) == before


def test_the_slot_of_another_actor_is_copied_and_not_read(
    make_armature, animate, keys_of, rewrite, scene_io
):
    armature = make_armature()
    action = animate(armature)
    slot = action.slots.new("OBJECT", "Somebody")
    bag = action.layers[0].strips[0].channelbag(slot, ensure=True)
    bag.fcurves.new('pose.bones["Head"].rotation_quaternion', index=0).keyframe_points.insert(
        5, 9
    )

    clean = rewrite(armature)

    assert armature.animation_data.action_slot.identifier == "OBActor"
    path = 'pose.bones["Head"].rotation_quaternion'
    assert keys_of(clean)["OBSomebody", path, 0] == keys_of(action)["OBSomebody", path, 0]


def test_muted_channels_count_as_not_keyed_and_stay(
    make_armature, animate, keys_of, rewrite, scene_io
):
    armature = make_armature(mode="XYZ")
    action = animate(armature)
    path = 'pose.bones["Head"].rotation_euler'
    bag = action.layers[0].strips[0].channelbag(action.slots[0])
    for index in range(3):
        bag.fcurves.find(path, index=index).mute = True
    before = keys_of(action)

    take = scene_io.reading.read_take(armature, armature.users_scene[0])
    after = keys_of(rewrite(armature))

    head = take.rig.bones.index("Head")
    assert not take.channels[head].rotation_keyed
    assert np.ptp(take.channels[head].rotations, axis=0).max() == 0.0
    assert all(before[key] == after[key] for key in before if key[1] == path)


def test_a_linked_action_is_read_and_never_written(
    make_armature, animate, tmp_path, blank, keys_of, rewrite
):
    armature = make_armature()
    action = animate(armature)
    raw = keys_of(action)
    blank.data.libraries.write(str(tmp_path / "takes.blend"), {action}, fake_user=True)
    with blank.data.libraries.load(str(tmp_path / "takes.blend"), link=True) as (_, into):
        into.actions = ["walk"]
    linked = into.actions[0]
    armature.animation_data.action = linked
    armature.animation_data.action_slot = linked.slots[0]

    clean = rewrite(armature)

    assert linked.library is not None and keys_of(linked) == raw
    assert clean.library is None and armature.animation_data.action == clean


def test_a_linked_rig_is_read_and_an_override_gets_the_result(
    make_armature, animate, tmp_path, blank, scene_io, rewrite
):
    armature = make_armature()
    animate(armature)
    path = str(tmp_path / "rig.blend")
    blank.data.libraries.write(path, {armature}, fake_user=True)
    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with blank.data.libraries.load(path, link=True) as (_, into):
        into.objects = ["Actor"]
    linked = into.objects[0]
    blank.context.scene.collection.objects.link(linked)

    take = scene_io.reading.read_take(linked, blank.context.scene)

    assert take.parts[0].motion.n_frames == 60
    with pytest.raises(
        scene_io.errors.InvalidMotionError, match=r"Actor is linked from rig.blend"
    ):
        scene_io.writing.check_writable(linked)
    override = linked.override_create(remap_local_usages=True)
    clean = rewrite(override)
    assert override.animation_data.action == clean and clean.library is None


@pytest.mark.parametrize(
    ("scale", "unit_scale", "meters"),
    [(1.0, 1.0, 1.0), (2.0, 1.0, 2.0), (100.0, 1.0, 1.0), (100.0, 0.01, 1.0), (17.7, 1.0, 1.0)],
)
def test_bones_have_plausible_lengths_at_any_scale(
    scale, unit_scale, meters, make_armature, animate, poses, rewrite, scene_io, blank
):
    """BVH in centimeters or in CMU's unit is often imported as if it were meters."""
    armature, scene = make_armature(), blank.context.scene
    animate(armature)
    armature.scale = (scale,) * 3
    scene.unit_settings.scale_length = unit_scale
    before = poses(armature, range(1, 61))

    motion = scene_io.reading.read_take(armature, scene).parts[0].motion

    thigh = np.linalg.norm(motion.skeleton.offsets[motion.skeleton.index("LeftLeg")])
    assert_allclose(thigh, 0.45 * meters, rtol=0.01)
    rewrite(armature)
    for bone, matrices in poses(armature, range(1, 61)).items():
        assert_allclose(matrices, before[bone], atol=TOLERANCE_M * scale)


def test_unevenly_scaled_armatures_are_refused_with_a_reason(make_armature, animate, scene_io):
    armature = make_armature()
    animate(armature)
    armature.scale = (1, 1, 2)

    with pytest.raises(
        scene_io.errors.InvalidMotionError,
        match=r"Actor is scaled unevenly or sheared \(1, 1, 2",
    ):
        scene_io.reading.read_take(armature, armature.users_scene[0])


def test_error_names_the_missing_input(make_armature, blank, scene_io):
    armature, scene = make_armature(), blank.context.scene
    with pytest.raises(scene_io.errors.InvalidMotionError, match="Actor has no action"):
        scene_io.reading.read_take(armature, scene)
    action = armature.animation_data_create().action = blank.data.actions.new("empty")
    with pytest.raises(
        scene_io.errors.InvalidMotionError, match="uses no slot of its action empty"
    ):
        scene_io.reading.read_take(armature, scene)
    armature.animation_data.action_slot = action.slots.new("OBJECT", "Actor")
    with pytest.raises(
        scene_io.errors.InvalidMotionError, match="The action has no keys on this"
    ):
        scene_io.reading.read_take(armature, scene)
