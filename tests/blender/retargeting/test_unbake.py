"""Few keys for the same motion, as Blender plays them."""

import json

import numpy as np
import pytest

ENDS = ("LeftHand", "RightHand", "LeftToeBase", "RightToeBase", "Head")
HALF_A_CENTIMETER = 0.005


def n_keys(keys):
    return sum(map(len, keys.values()))


@pytest.mark.parametrize("mode", ["QUATERNION", "ZXY", "AXIS_ANGLE"])
def test_hand_and_foot_errors_stay_within_the_tolerance(
    walker, blank, poses, keys_of, load, mode
):
    rekeyed(walker, mode, load)
    raw = walker.animation_data.action
    before, frames = keys_of(raw), range(1, 61)
    truth = poses(walker, frames)

    assert blank.ops.mocap_assist.reduce_keys(tolerance=HALF_A_CENTIMETER) == {"FINISHED"}

    action = walker.animation_data.action
    assert action.name == f"{raw.name}.sparse" and keys_of(raw) == before
    assert n_keys(keys_of(action)) < 0.4 * n_keys(before)
    played = poses(walker, frames)
    off = [np.abs(played[name][:, :3, 3] - truth[name][:, :3, 3]).max() for name in ENDS]
    assert 0.0 < max(off) < HALF_A_CENTIMETER
    entry = json.loads(action["mocap_assist_history"])[-1]
    assert entry["operation"] == "reduce_keys"
    assert entry["keys_after"] == n_keys(keys_of(action))


def test_a_larger_tolerance_leaves_fewer_keys(walker, blank, keys_of):
    raw, found = walker.animation_data.action, []
    for tolerance in (0.001, 0.01, 0.05):
        walker.animation_data.action = raw
        blank.ops.mocap_assist.reduce_keys(tolerance=tolerance)
        found.append(n_keys(keys_of(walker.animation_data.action)))

    assert found[0] > found[1] > found[2]


def test_unbaked_action_can_be_unbaked_again_and_reverted(walker, blank, keys_of):
    raw = walker.animation_data.action
    for tolerance in (0.002, 0.03):
        assert blank.ops.mocap_assist.reduce_keys(tolerance=tolerance) == {"FINISHED"}

    action = walker.animation_data.action
    assert action.name.startswith(f"{raw.name}.sparse")
    assert n_keys(keys_of(action)) < n_keys(keys_of(blank.data.actions[f"{raw.name}.sparse"]))
    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}
    assert walker.animation_data.action == raw


def test_unbake_refuses_gaps(walker, blank):
    bag = walker.animation_data.action.layers[0].strips[0].channelbags[0]
    for curve in bag.fcurves:
        if "LeftForeArm" in curve.data_path:
            for key in list(curve.keyframe_points)[10:50][::-1]:
                curve.keyframe_points.remove(key)

    with pytest.raises(RuntimeError, match=r"LeftForeArm\. Clean the take first"):
        blank.ops.mocap_assist.reduce_keys()


def rekeyed(armature, mode, load):
    """Key the same rotations in another rotation mode."""
    modes = load("mocap_assist.actions.rotation_modes")
    reading = load("mocap_assist.actions.armature_read")
    writing = load("mocap_assist.actions.action_write")
    compat = load("mocap_assist.blender.compat")
    controls = load("mocap_assist.scene.controls")
    import bpy

    take = reading.read_take(armature, bpy.context.scene)
    name = armature.animation_data.action.name
    assert modes.rotation_property(mode)
    keys = {
        bone: controls.BoneKeys(
            channels.rotations, channels.locations if channels.travels else None
        )
        for bone, channels in zip(take.rig.bones, take.channels, strict=True)
    }
    for bone in armature.pose.bones:
        bone.rotation_mode = mode
    made = writing.write_action(armature, f"{name}.{mode}", take.frames, keys, {})
    compat.assign(armature, *made)
