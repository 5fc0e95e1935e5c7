"""Which frames are read, which of them are gaps, and which bone carries the body."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal


def curve_of(action, path, index=0):
    return (
        action.layers[0].strips[0].channelbag(action.slots[0]).fcurves.find(path, index=index)
    )


def remove_keys(action, bone, start, stop):
    bag = action.layers[0].strips[0].channelbag(action.slots[0])
    for curve in bag.fcurves:
        if bone in curve.data_path:
            for key in reversed(curve.keyframe_points):
                if start <= key.co.x <= stop:
                    curve.keyframe_points.remove(key)


@pytest.mark.parametrize(
    ("keyed", "expected"),
    [
        (np.arange(1.0, 61.0), np.arange(1.0, 61.0)),
        (np.arange(1.0, 61.0, 0.25), np.arange(1.0, 61.0, 0.25)),  # 120 Hz in a 30 Hz scene
        (np.arange(1.5, 61.0), np.arange(1.5, 61.0)),
        (np.arange(2.0, 61.0, 2.0), np.arange(2.0, 61.0, 2.0)),
        (np.array([1.0, 12.0, 15.0, 40.0]), np.arange(1.0, 41.0)),  # keyed by hand
    ],
)
def test_read_frames_equal_the_key_frames(
    keyed, expected, make_armature, animate, scene_io, blank
):
    armature, scene = make_armature(), blank.context.scene
    scene.render.fps = 30
    animate(armature, frames=keyed)

    take = scene_io.reading.read_take(armature, scene)

    assert_allclose(take.frames, expected, atol=1e-4)
    assert take.parts[0].motion.frame_rate == pytest.approx(30 / (expected[1] - expected[0]))
    assert take.parts[0].motion.observed.all()


def test_a_long_take_between_frames_keeps_all_its_samples(
    make_armature, animate, scene_io, blank
):
    """Five minutes at 120 Hz in a scene at 24: single precision blurs the times of the keys."""
    armature, scene = make_armature(), blank.context.scene
    scene.render.fps = 24
    keyed = 1.0 + np.arange(36000) / 5.0
    animate(armature, frames=keyed)

    take = scene_io.reading.read_take(armature, scene)

    assert len(take.frames) == 36000
    assert_allclose(take.frames, keyed, atol=1e-3)
    assert take.parts[0].motion.frame_rate == pytest.approx(120.0, rel=1e-5)


@pytest.mark.parametrize("keyed", [np.arange(1.0, 61.0, 0.25), np.arange(1.5, 61.0)])
def test_keys_between_frames_are_preserved_exactly(
    keyed, make_armature, animate, scene_io, blank, keys_of
):
    armature = make_armature(mode="XYZ")
    action = animate(armature, frames=keyed)
    take = scene_io.reading.read_take(armature, blank.context.scene)

    source = scene_io.reading.action_of(armature)
    clean, _ = scene_io.writing.write_take(armature, source, take, take.rig.bones, {})

    for name, keys in keys_of(clean).items():
        assert_allclose(
            [key[:2] for key in keys], [key[:2] for key in keys_of(action)[name]], atol=1e-6
        )


def test_range_is_that_of_scene_preview_or_selection(make_armature, animate, scene_io, blank):
    armature, scene = make_armature(), blank.context.scene
    action = animate(armature)
    ranges, read = scene_io.frames.FrameRange, scene_io.reading.read_take
    scene.frame_start, scene.frame_end = 10, 500
    with pytest.raises(scene_io.errors.InvalidMotionError, match="no preview range"):
        read(armature, scene, ranges.PREVIEW)
    scene.use_preview_range, scene.frame_preview_start, scene.frame_preview_end = True, 20, 30

    bounds = [
        read(armature, scene, each).frames[[0, -1]].tolist()
        for each in ranges
        if each is not ranges.SELECTED_KEYS
    ]
    assert bounds == [[1, 60], [10, 60], [20, 30]]
    for curve in action.layers[0].strips[0].channelbag(action.slots[0]).fcurves:
        for key in curve.keyframe_points:
            key.select_control_point = "Hips" in curve.data_path and 40 <= key.co.x <= 44
    assert read(armature, scene, ranges.SELECTED_KEYS).frames[[0, -1]].tolist() == [40, 44]
    scene.frame_start = 100
    with pytest.raises(
        scene_io.errors.InvalidMotionError, match="from frame 1 to 60, none of them"
    ):
        read(armature, scene, ranges.SCENE)


def test_keys_outside_the_range_stay_bit_for_bit(
    make_armature, animate, scene_io, blank, keys_of
):
    armature, scene = make_armature(), blank.context.scene
    action = animate(armature)
    scene.frame_start, scene.frame_end = 20, 40
    take = scene_io.reading.read_take(armature, scene, scene_io.frames.FrameRange.SCENE)
    still = np.tile([1.0, 0, 0, 0], (21, len(take.parts[0].bones), 1))
    take = take.with_recordings((take.parts[0].motion.with_poses(still),))

    source = scene_io.reading.action_of(armature)
    clean, _ = scene_io.writing.write_take(armature, source, take, take.rig.bones, {})

    raw = keys_of(action)
    for name, keys in keys_of(clean).items():
        assert len(keys) == 60
        assert [key[:2] for key in keys[:19] + keys[40:]] == [
            key[:2] for key in raw[name][:19] + raw[name][40:]
        ]
    head = keys_of(clean)["OBActor", 'pose.bones["Head"].rotation_quaternion', 0]
    assert [key[1] for key in head[19:40]] == [1.0] * 21


def test_missing_keys_of_a_recorded_bone_are_a_gap(make_armature, animate, scene_io, blank):
    armature = make_armature()
    action = animate(armature)
    remove_keys(action, "LeftArm", 20, 30)
    remove_keys(action, "RightArm", 50, 60)

    motion = scene_io.reading.read_take(armature, blank.context.scene).parts[0].motion

    for bone, start, stop in (("LeftArm", 20, 31), ("RightArm", 50, 61)):
        gap = ~motion.observed[:, motion.skeleton.index(bone)]
        assert_array_equal(np.flatnonzero(gap) + 1, np.arange(start, stop))
    assert (~motion.observed).sum() == 22


def test_curves_of_other_programs_hold_their_ends(make_armature, animate, scene_io, blank):
    """Of Unity's jump in FBX, hips have keys in a fifth of the take."""
    armature = make_armature()
    action = animate(armature)
    remove_keys(action, "Hips", 1, 20)
    remove_keys(action, "Hips", 50, 60)
    remove_keys(action, "RightArm", 30, 40)

    take = scene_io.reading.read_take(armature, blank.context.scene, holds_ends=True)

    motion = take.parts[0].motion
    assert motion.observed[:, motion.skeleton.index("Hips")].all()
    gap = ~motion.observed[:, motion.skeleton.index("RightArm")]
    assert_array_equal(np.flatnonzero(gap) + 1, np.arange(30, 41))
    assert_allclose(motion.root_positions[:20], motion.root_positions[20:21].repeat(20, axis=0))


def test_held_pose_with_removed_keys_is_no_gap(make_armature, animate, scene_io, blank):
    armature = make_armature()
    action = animate(armature)
    for index in range(4):
        for key in curve_of(
            action, 'pose.bones["Head"].rotation_quaternion', index
        ).keyframe_points:
            if 20 <= key.co.x <= 30:
                key.co.y = 0.5
    remove_keys(action, "Head", 21, 29)

    motion = scene_io.reading.read_take(armature, blank.context.scene).parts[0].motion

    assert motion.observed.all()


@pytest.mark.parametrize("change", [0.004, 0.04])
def test_keys_that_an_exporter_removed_are_no_gap(
    make_armature, animate, scene_io, blank, change
):
    armature = make_armature()
    action = animate(armature)
    for index in range(4):
        curve = curve_of(action, 'pose.bones["Head"].rotation_quaternion', index)
        for key in curve.keyframe_points:
            if 20 <= key.co.x <= 30:
                key.co.y = 0.5 + (key.co.x == 30) * change
    remove_keys(action, "Head", 21, 29)

    motion = scene_io.reading.read_take(armature, blank.context.scene).parts[0].motion

    assert motion.observed.all() == (change < 0.01)


def test_one_or_two_keys_that_are_missing_between_others_are_no_gap(
    make_armature, animate, scene_io, blank
):
    armature = make_armature()
    action = animate(armature)
    remove_keys(action, "Head", 20, 21)
    remove_keys(action, "LeftArm", 30, 30)
    remove_keys(action, "RightArm", 40, 42)

    motion = scene_io.reading.read_take(armature, blank.context.scene).parts[0].motion

    assert (~motion.observed).sum() == 3


def test_one_channel_without_keys_is_no_gap(make_armature, animate, scene_io, blank):
    armature = make_armature(mode="XYZ")
    action = animate(armature)
    curve = curve_of(action, 'pose.bones["Head"].rotation_euler', 2)
    for key in list(curve.keyframe_points)[20:30][::-1]:
        curve.keyframe_points.remove(key)

    assert (
        scene_io.reading.read_take(armature, blank.context.scene).parts[0].motion.observed.all()
    )


UNREAL = {
    "root": (None, (0, 0, 0), (0, 0, 0.1), False),
    "pelvis": ("root", (0, 0, 1), (0, 0, 1.1), False),
    "spine_01": ("pelvis", (0, 0, 1.1), (0, 0, 1.3), False),
    "head": ("spine_01", (0, 0, 1.5), (0, 0, 1.7), False),
    "upperarm_l": ("spine_01", (0.2, 0, 1.4), (0.5, 0, 1.4), False),
    "hand_l": ("upperarm_l", (0.5, 0, 1.4), (0.8, 0, 1.4), False),
    "thumb_01_l": ("hand_l", (0.8, 0, 1.4), (0.9, 0, 1.4), False),
    "thigh_l": ("pelvis", (0.1, 0, 1), (0.1, 0, 0.5), False),
    "foot_l": ("thigh_l", (0.1, 0, 0.1), (0.1, -0.2, 0), False),
    "ball_l": ("foot_l", (0.1, -0.2, 0.02), (0.1, -0.3, 0), False),
    "ik_foot_root": ("root", (0, 0, 0), (0, 0, 0.1), False),
    "ik_foot_l": ("ik_foot_root", (0.1, 0, 0.1), (0.1, 0, 0.2), False),
}


def test_pelvis_below_a_moving_root_is_read_and_written_in_world_space(
    make_armature, animate, poses, scene_io, blank
):
    armature = make_armature(UNREAL)
    action = animate(armature, locations=True)
    before = poses(armature, range(1, 61))

    take = scene_io.reading.read_take(armature, blank.context.scene)

    names = [part.motion.skeleton.names[0] for part in take.parts]
    assert names == ["pelvis", "ik_foot_root"]
    pelvis = take.parts[0].motion
    assert_allclose(pelvis.root_positions, before["pelvis"][:, :3, 3], atol=2e-5)
    positions = scene_io.kinematics.forward_kinematics(pelvis).positions
    shown = before["spine_01"][:, :3, 3]
    moved = take.offsets.positions[:, take.offsets.names.index("spine_01")]
    offset = scene_io.rotations.rotate(pelvis.rotations[:, 0], moved)
    assert_allclose(positions[:, pelvis.skeleton.index("spine_01")] + offset, shown, atol=2e-5)
    source = scene_io.reading.action_of(armature)
    clean, slot = scene_io.writing.write_take(armature, source, take, take.rig.bones, {})
    assert clean != action
    armature.animation_data.action, armature.animation_data.action_slot = clean, slot
    for bone, matrices in poses(armature, range(1, 61)).items():
        assert_allclose(matrices, before[bone], atol=2e-5)


def test_only_moving_root_is_the_body_root(make_armature, animate, scene_io, blank):
    armature = make_armature(UNREAL)
    animate(armature)  # only the root moves

    take = scene_io.reading.read_take(armature, blank.context.scene)

    assert [part.motion.skeleton.names[0] for part in take.parts] == ["root"]


def test_spine_with_many_fingers_is_not_the_root(make_armature, animate, scene_io, blank):
    fingers = {
        f"finger_{index}": ("hand_l", (0.8, 0.01 * index, 1.4), (0.9, 0.01 * index, 1.4), False)
        for index in range(10)
    }
    armature = make_armature(UNREAL | fingers)
    animate(armature, locations=True)

    take = scene_io.reading.read_take(armature, blank.context.scene)

    assert take.parts[0].motion.skeleton.names[0] == "pelvis"
