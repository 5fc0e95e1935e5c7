"""What Clean does with next to nothing, and what it says when it can do nothing."""

import pytest
from numpy.testing import assert_allclose

CLEAN = "walk.clean"


def test_clean_reports_an_empty_selection(noisy, clean, load):
    compat = load("mocap_assist.blender.compat")
    for bone in noisy.pose.bones:
        compat.select_bone(bone, False)

    with pytest.raises(RuntimeError, match=r"No bones are selected\. Select some in Pose Mode"):
        clean(bones="SELECTED")


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (lambda bpy, rig: setattr(rig.animation_data, "action", None), "Actor has no action"),
        (
            lambda bpy, rig: setattr(bpy.context.view_layer.objects, "active", None),
            "Select an animated armature",
        ),
        (
            lambda bpy, rig: (
                rig.animation_data.action.layers[0].strips[0].channelbags[0].fcurves.clear()
            ),
            "The action has no keys on this armature's bones",
        ),
    ],
)
def test_clean_reports_invalid_input_in_one_sentence(spoil, sentence, noisy, clean, blank):
    spoil(blank, noisy)

    with pytest.raises(RuntimeError, match=sentence):
        clean()


def test_action_locked_by_tweak_mode_is_not_changed(noisy, clean, blank):
    clean(result_as="NLA_TRACK")
    noisy.animation_data.nla_tracks[0].strips[0].select = True
    noisy.animation_data.use_tweak_mode = True
    actions = blank.data.actions.keys()

    with pytest.raises(RuntimeError, match="Actor is in tweak mode, which locks its action"):
        clean()

    assert blank.data.actions.keys() == actions


def test_bone_without_keys_is_unchanged(noisy, clean, keys_of):
    action = noisy.animation_data.action
    bag = action.layers[0].strips[0].channelbag(action.slots[0])
    for curve in [curve for curve in bag.fcurves if "Spine" in curve.data_path]:
        bag.fcurves.remove(curve)

    assert not any("Spine" in path for _, path, _ in keys_of(clean()))


def test_clean_accepts_two_bones(make_armature, animate, clean, blank):
    bones = {
        "upper": (None, (0, 0, 0), (0, 0, 1), False),
        "lower": ("upper", (0, 0, 1), (0, 0, 2), True),
    }
    armature = make_armature(bones)
    animate(armature)

    assert clean(plant_feet=True).name == CLEAN


def test_clean_accepts_one_frame(make_armature, animate, clean, keys_of):
    armature = make_armature(mode="XYZ")
    raw = keys_of(animate(armature, frames=[1]))

    after = keys_of(clean(plant_feet=True))

    for name, keys in after.items():
        if name in raw:
            assert_allclose(
                [key[:2] for key in keys], [key[:2] for key in raw[name]], atol=1e-4
            )
