"""Odd takes: a correct result, or one sentence and an unchanged scene."""

import numpy as np
import pytest
from armature_fixtures import BONES

ARM = {name: BONES[name] for name in ("Hips", "Spine", "LeftArm", "LeftForeArm")}
AWKWARD = ['Bone "L"', "back\\slash", "Größe_骨", "a.b[0]", "new\nline"]


@pytest.fixture
def press(blank, keys_of):
    """Press Clean; check what no input may break; return the raw and the new keys."""

    def button(armature, **settings):
        raw = armature.animation_data.action
        before = repr(keys_of(raw))  # as text, in which NaN equals NaN
        settings = {"plant_feet": False} | settings

        assert blank.ops.mocap_assist.denoise(**settings) == {"FINISHED"}

        result = armature.animation_data.action
        assert repr(keys_of(raw)) == before
        assert result != raw
        after = keys_of(result)
        assert np.isfinite([key[:2] for keys in after.values() for key in keys]).all()
        return keys_of(raw), after

    return button


@pytest.fixture
def spoil():
    """Change the values of all curves whose path ends so: `spoil(action, "location", f)`."""

    def change(action, path, values):
        for curve in action.layers[0].strips[0].channelbags[0].fcurves:
            if curve.data_path.endswith(path):
                keys = np.empty(2 * len(curve.keyframe_points), dtype=np.float32)
                curve.keyframe_points.foreach_get("co", keys)
                keys[1::2] = values(keys[::2], keys[1::2], curve.array_index)
                curve.keyframe_points.foreach_set("co", keys)
                curve.update()

    return change


def values_of(keys, bone, name):
    """The values of a bone's property, shape (n_keys, n_components)."""
    found = {
        index: [key[1] for key in curve]
        for (_, path, index), curve in keys.items()
        if path == f'pose.bones["{bone}"].{name}'
    }
    return np.array([found[index] for index in sorted(found)]).T


@pytest.mark.parametrize("n_frames", [1, 2, 3])
def test_a_few_frames_keep_their_keys(make_armature, animate, press, n_frames):
    armature = make_armature(ARM, mode="XYZ")
    animate(armature, frames=range(1, n_frames + 1))

    raw, after = press(armature)

    assert {name: len(keys) for name, keys in raw.items()}.items() <= {
        name: len(keys) for name, keys in after.items()
    }.items()


def test_single_bone_is_cleaned(make_armature, animate, press):
    armature = make_armature({"Hips": BONES["Hips"]})
    animate(armature)

    raw, after = press(armature, plant_feet=True)

    assert raw.keys() == after.keys()


@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ"])
def test_nan_keys_become_finite(make_armature, animate, press, spoil, mode):
    armature = make_armature(ARM, mode=mode)
    action = animate(armature)
    path = "rotation_quaternion" if mode == "QUATERNION" else "rotation_euler"
    spoil(
        action, f'"LeftArm"].{path}', lambda t, y, n: np.where((t > 20) & (t < 30), np.nan, y)
    )
    spoil(action, "location", lambda t, y, n: np.where(t == 40, np.nan, y))

    press(armature)


def test_quaternions_of_any_length_and_sign_are_accepted(make_armature, animate, press, spoil):
    armature = make_armature(ARM)
    action = animate(armature)
    plain = press(armature)[1]
    armature.animation_data.action = action
    spoil(action, "rotation_quaternion", lambda t, y, n: y * np.where(t % 7 < 3, -4.0, 0.2))

    other = press(armature)[1]

    for bone in ARM:
        one, two = (values_of(keys, bone, "rotation_quaternion") for keys in (plain, other))
        dots = (
            (one * two).sum(axis=1) / np.linalg.norm(one, axis=1) / np.linalg.norm(two, axis=1)
        )
        assert np.abs(dots).min() > np.cos(np.radians(0.5))


def test_zero_quaternions_are_accepted(make_armature, animate, press, spoil):
    armature = make_armature(ARM)
    spoil(animate(armature), '"Spine"].rotation_quaternion', lambda t, y, n: 0 * y)

    press(armature)


def test_jumps_of_360_degrees_do_not_change_the_pose(
    make_armature, animate, press, spoil, poses
):
    armature = make_armature(ARM, mode="XYZ")
    spoil(animate(armature), "rotation_euler", lambda t, y, n: y + 2 * np.pi * (t % 5 < 2))
    frames = range(1, 61)
    before = poses(armature, frames)

    press(armature)

    after = poses(armature, frames)
    for bone in ARM:
        assert np.abs(after[bone] - before[bone])[5:-5].max() < 0.05


@pytest.mark.parametrize("size", [1e6, 1e30])
def test_distant_position_is_cleaned_or_refused(
    make_armature, animate, press, spoil, blank, size
):
    armature = make_armature(ARM)
    spoil(animate(armature), "location", lambda t, y, n: y * size)
    actions = len(blank.data.actions)

    try:
        press(armature)
    except RuntimeError as error:
        assert "Traceback" not in str(error)
        assert len(blank.data.actions) == actions


@pytest.mark.parametrize(
    "frames",
    [range(-40, 20), np.arange(60) * 0.5 - 7.25, np.arange(30) + 100_000],
    ids=["negative", "sub-frames", "late"],
)
@pytest.mark.parametrize("fps", [(24, 1.0), (30, 1.001), (240, 1.0)])
def test_keys_stay_on_their_frames(make_armature, animate, press, blank, frames, fps):
    blank.context.scene.render.fps, blank.context.scene.render.fps_base = fps
    armature = make_armature(ARM)
    animate(armature, frames=frames)

    raw, after = press(armature)

    for name, keys in raw.items():
        assert [key[0] for key in after[name]] == [key[0] for key in keys]


def test_a_range_without_keys_is_reported(make_armature, animate, blank):
    armature = make_armature(ARM)
    animate(armature)
    blank.context.scene.frame_start, blank.context.scene.frame_end = 500, 600

    with pytest.raises(RuntimeError) as refused:
        blank.ops.mocap_assist.denoise(frame_range="SCENE")

    assert "Traceback" not in str(refused.value)
    assert len(blank.data.actions) == 1


def test_hidden_bones_and_locked_channels_are_cleaned_like_others(
    make_armature, animate, press, spoil, rng
):
    armature = make_armature(ARM)
    action = animate(armature)
    for bone in armature.pose.bones:
        bone.lock_rotation = (True, True, True)
        bone.lock_location = (True, True, True)
        bone.bone.hide = True
    spoil(
        action, "rotation_quaternion", lambda t, y, n: y + rng.normal(scale=0.05, size=len(y))
    )

    raw, after = press(armature)

    for bone in ARM:
        rough = [
            np.abs(np.diff(values_of(keys, bone, "rotation_quaternion"), n=3, axis=0)).mean()
            for keys in (raw, after)
        ]
        assert rough[1] < 0.7 * rough[0]


def test_names_that_need_escaping_are_accepted(make_armature, animate, press, blank):
    bones = {name: (None, (n, 0, 0), (n, 0, 1), False) for n, name in enumerate(AWKWARD)}
    armature = make_armature(bones, mode="XYZ")
    escaped = [blank.utils.escape_identifier(bone.name) for bone in armature.pose.bones]
    for bone in armature.pose.bones:
        for frame in range(1, 41):
            bone.rotation_euler.x = 0.5 * np.sin(frame / 5) + 0.1 * (frame % 2)
            bone.keyframe_insert("rotation_euler", frame=frame)

    raw, after = press(armature)

    assert {path for _, path, _ in raw} == {path for _, path, _ in after}
    for name in escaped:
        before, cleaned = (values_of(keys, name, "rotation_euler") for keys in (raw, after))
        assert (
            np.abs(np.diff(cleaned[:, 0], n=2)).mean()
            < np.abs(np.diff(before[:, 0], n=2)).mean()
        )


def test_action_without_rotations_is_cleaned(make_armature, animate, press):
    armature = make_armature(ARM)
    action = animate(armature)
    curves = action.layers[0].strips[0].channelbags[0].fcurves
    for curve in [curve for curve in curves if "rotation" in curve.data_path]:
        curves.remove(curve)

    raw, after = press(armature)

    assert raw.keys() == after.keys()


def test_slot_of_another_actor_is_ignored(make_armature, animate, blank):
    armature = make_armature(ARM)
    action = animate(armature)
    other = make_armature(ARM, name="Other")
    other.animation_data_create().action = action
    other.animation_data.action_slot = None

    with pytest.raises(RuntimeError) as refused:
        blank.ops.mocap_assist.denoise()

    assert "Traceback" not in str(refused.value)
    assert len(blank.data.actions) == 1


def test_examples_of_an_unrelated_rig_are_ignored(make_armature, animate, press, blank):
    strange = {"p": (None, (0, 0, 0), (0, 0, 1), False), "q": ("p", (0, 0, 1), (0, 0, 2), True)}
    animate(make_armature(strange, name="Strange")).name = "rehearsal"
    armature = make_armature(ARM)
    animate(armature)

    try:
        press(armature, prior="EXAMPLES", examples="rehearsal")
    except RuntimeError as error:
        assert "Traceback" not in str(error)


def test_check_accepts_bad_takes(make_armature, animate, spoil, blank):
    armature = make_armature(ARM)
    action = animate(armature, frames=[1, 2])
    assert blank.ops.mocap_assist.measure_quality() == {"FINISHED"}
    spoil(action, "rotation_quaternion", lambda t, y, n: np.nan * y)

    try:
        blank.ops.mocap_assist.measure_quality()
    except RuntimeError as error:
        assert "Traceback" not in str(error)
