"""What Clean changes by body part: strength, with keys, and selected legs."""

import numpy as np
import pytest
from numpy.testing import assert_allclose


def values(keys):
    return {name: [key[1] for key in column] for name, column in keys.items()}


@pytest.fixture
def key_strength(blank):
    """Key a strength of the sidebar, from 0 at frame 20 to 1 at frame 21."""

    def key(name):
        scene = blank.context.scene
        for frame, value in ((20, 0.0), (21, 1.0)):
            setattr(scene.mocap_assist.clean, name, value)
            scene.keyframe_insert(f"mocap_assist.clean.{name}", frame=frame)

    return key


def test_part_of_strength_zero_keeps_its_recorded_values(noisy, clean, keys_of):
    action = noisy.animation_data.action
    for curve in action.layers[0].strips[0].channelbag(action.slots[0]).fcurves:
        if curve.data_path == 'pose.bones["LeftArm"].rotation_euler':
            for key in list(curve.keyframe_points)[30:]:
                key.co.y += 2.0 * np.pi  # which a rotation does not know
    before = values(keys_of(noisy.animation_data.action))

    after = values(keys_of(clean(strength_arms=0.0, strength_hands=0.0)))

    kept = {path for (_, path, index), column in after.items()
            if column == before["OBActor", path, index]}  # fmt: skip
    bones = {path.split('"')[1] for path in kept}
    assert bones and all("Arm" in name or "Shoulder" in name for name in bones), bones
    assert not any("Arm" in path for _, path, _ in after if path not in kept)


def test_feet_are_planted_at_any_strength(blank, clean, keys_of):
    assert blank.ops.mocap_assist.load_sample() == {"FINISHED"}
    before = values(keys_of(blank.context.object.animation_data.action))
    parts = ("trunk", "arms", "legs", "head", "hands")

    after = values(
        keys_of(clean(plant_feet=True, **{f"strength_{part}": 0.0 for part in parts}))
    )

    changed = {path.split('"')[1] for (slot, path, index), column in before.items()
               if after[slot, path, index] != column}  # fmt: skip
    assert {"LeftUpLeg", "LeftLeg", "RightUpLeg", "RightLeg"} <= changed
    assert not {"Spine", "Neck", "Head", "LeftForeArm"} & changed


def test_hands_are_held_only_if_the_arms_are_chosen(blank, clean, keys_of, load):
    assert blank.ops.mocap_assist.load_sample() == {"FINISHED"}
    armature = blank.context.object
    contact_keys = load("mocap_assist.actions.contact_keys")
    action = armature.animation_data.action
    first, last = map(int, action.frame_range)
    frames = np.arange(first, last + 1.0)
    contacts = np.zeros((len(frames), 7), bool)
    contacts[: len(frames) // 2] = True
    source = action, armature.animation_data.action_slot
    contact_keys.write_contacts(armature, *source, frames, contacts)
    before = keys_of(action)
    for bone in armature.pose.bones:
        is_leg = "Leg" in bone.name or "Foot" in bone.name
        load("mocap_assist.blender.compat").select_bone(bone, is_leg)

    after = keys_of(clean(bones="SELECTED", plant_feet=True))

    changed = {
        path.split('"')[1]
        for (slot, path, index), keys in after.items()
        if path.startswith("pose") and keys != before[slot, path, index]
    }
    assert "LeftLeg" in changed and not any("Arm" in name for name in changed), changed


@pytest.mark.parametrize("name", ["strength", "strength_head"])
def test_keys_set_the_strength_at_each_frame(
    noisy, clean, keys_of, key_strength, blank, name, load, capfd
):
    head = "OBActor", 'pose.bones["Head"].rotation_euler', 0
    raw = values(keys_of(noisy.animation_data.action))[head]
    full = values(keys_of(clean()))[head]
    blank.ops.mocap_assist.revert_to_raw()
    key_strength(name)

    result = clean()
    keyed = values(keys_of(result))[head]
    entry = load("mocap_assist.scene.history").history(result)[-1]
    assert "Keys of Strength were used" in capfd.readouterr().out
    blank.ops.mocap_assist.revert_to_raw()
    without = values(keys_of(clean(keyed_strength=False)))[head]

    assert entry["keyed_strengths"] == [name]
    assert "Keys of Strength" not in capfd.readouterr().out
    assert keyed[:20] == raw[:20]
    assert_allclose(keyed[20:], full[20:], atol=1e-6)
    assert without == full and np.abs(np.subtract(raw, full)).max() > 0.01
