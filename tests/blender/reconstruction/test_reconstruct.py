"""The button Reconstruct: a new action, plausible where the camera was wrong."""

import json

import numpy as np
import pytest
from kinect_walks import HIDDEN, OCCLUDED_FRAMES
from numpy.testing import assert_allclose, assert_array_equal

HISTORY, SOURCE = "mocap_assist_history", "mocap_assist_source"
GENERATED = 5


@pytest.fixture
def body(load, blank):
    """Read where the joints of an armature's action are, by name."""

    def read(armature):
        take = load("mocap_assist.actions.armature_read").read_take(
            armature, blank.context.scene
        )
        motion = take.parts[0].motion
        positions = load("solvers.motion").forward_kinematics(motion).positions
        return dict(zip(motion.skeleton.names, np.moveaxis(positions, 1, 0), strict=True))

    return read


def test_result_is_a_new_action_and_the_recorded_one_stays(walk, reconstruct, keys_of):
    raw = walk.animation_data.action
    before = keys_of(raw)

    result = reconstruct()

    assert result.name == "walk.reconstructed"
    assert result.use_fake_user
    assert keys_of(raw) == before
    assert result[SOURCE] == raw
    entry = json.loads(result[HISTORY])[-1]
    assert entry["operation"] == "reconstruct"
    assert entry["settings"]["plant_feet"] is False
    assert 0.03 < entry["rebuilt_share"] < 0.2


def test_hidden_forearm_gets_nearer_to_the_truth(walk, reconstruct, body, truth):
    raw = body(walk)

    reconstruct()

    clean = body(walk)
    for name, joint in zip(HIDDEN, (5, 6, 7), strict=True):
        error = [
            np.nanmean(
                np.linalg.norm(
                    each[name][OCCLUDED_FRAMES] - truth[OCCLUDED_FRAMES, joint], axis=-1
                )
            )
            for each in (raw, clean)
        ]
        assert error[1] < 0.6 * error[0], name
    assert all(np.isfinite(positions).all() for positions in clean.values())


def test_reliable_joints_keep_their_positions(walk, reconstruct, body):
    raw = body(walk)

    reconstruct()

    clean = body(walk)
    for name in ("KneeRight", "AnkleLeft", "ElbowRight", "ShoulderCenter"):
        moved = np.linalg.norm(clean[name] - raw[name], axis=-1)
        assert np.nanmedian(moved) < 0.03, name


def test_reliability_is_stored_in_the_action(walk, reconstruct, load):
    result = reconstruct()

    reliability_at = load("mocap_assist.actions.reliability_curves").reliability_at
    source = (result, walk.animation_data.action_slot)
    hidden = reliability_at(source, ["WristLeft", "WristRight"], OCCLUDED_FRAMES.start + 15)
    visible = reliability_at(source, ["WristLeft", "WristRight"], 10)
    assert hidden["WristLeft"] < 0.3 < 0.6 < hidden["WristRight"]
    assert visible["WristLeft"] > 0.2 + hidden["WristLeft"]


def test_estimated_keys_have_the_type_generated(walk, reconstruct, blank):
    result = reconstruct()

    path = 'pose.bones["ElbowLeft"].rotation_quaternion'
    curves = result.layers[0].strips[0].channelbags[0].fcurves
    curve = next(each for each in curves if each.data_path == path)
    generated = [key.co.x for key in curve.keyframe_points if key.type == "GENERATED"]
    assert {OCCLUDED_FRAMES.start + 15.0} <= set(generated)
    assert not {10.0, 80.0} & set(generated)


def test_feet_that_are_planted_do_not_slide(walk, reconstruct):
    result = reconstruct(plant_feet=True)

    entry = json.loads(result[HISTORY])[-1]
    assert entry["after"]["foot_slide_cm_per_s"] < 0.3 * entry["before"]["foot_slide_cm_per_s"]


def test_frames_outside_of_the_range_stay_as_they_were(walk, reconstruct, keys_of, blank):
    scene = blank.context.scene
    scene.use_preview_range = True
    scene.frame_preview_start, scene.frame_preview_end = 25, 65
    before = keys_of(walk.animation_data.action)

    result = reconstruct(frame_range="PREVIEW")

    after = keys_of(result)
    changed = 0
    for path, keys in before.items():
        if "mocap" in path[0]:
            continue
        outside = [key for key in keys if not 25 <= key[0] <= 65]
        assert [key for key in after[path] if not 25 <= key[0] <= 65] == outside
        changed += keys != after[path]
    assert changed > 10


def test_second_reconstruction_starts_from_the_recording(walk, reconstruct, keys_of):
    first = reconstruct()

    second = reconstruct()

    assert second.name.startswith("walk.reconstructed")
    assert second != first
    again, once = keys_of(second), keys_of(first)
    assert again.keys() == once.keys()
    for path, keys in once.items():
        assert_allclose(again[path], keys, atol=1e-5, err_msg=str(path))
    assert len(json.loads(second[HISTORY])) == 1


def test_joints_outside_the_body_keep_their_rotations(
    make_armature, animate, reconstruct, blank
):
    """Joints without a role keep all rotations."""
    armature = make_armature()
    animate(armature)
    blank.context.scene.render.fps = 30

    result = reconstruct()

    assert result.name == "walk.reconstructed"
    raw = result[SOURCE]
    first, second = (
        [key.co.y for curve in each.layers[0].strips[0].channelbags[0].fcurves
         if "Head" in curve.data_path and "mocap" not in curve.data_path
         for key in curve.keyframe_points]
        for each in (raw, result)
    )  # fmt: skip
    assert_array_equal(np.shape(first), np.shape(second))


@pytest.mark.parametrize("kind", ["action", "folder"])
def test_postures_are_learned_from_given_clips(
    walk, reconstruct, load, blank, tmp_path, bring, kind
):
    samples = load("solvers.samples")
    clip = samples.walking_gait(samples.GaitSettings(duration=3.0, frame_rate=30.0))
    (tmp_path / "clean").mkdir()
    path = tmp_path / "clean" / "stroll.bvh"
    load("solvers.recordings").write_bvh(clip, path)
    if kind == "action":
        bring(path)
        blank.context.view_layer.objects.active = walk

    result = reconstruct(
        postures="EXAMPLES", examples="stroll" if kind == "action" else str(path.parent)
    )

    assert "1 clip of your own" in json.loads(result[HISTORY])[-1]["method"]


def test_message_fits_the_status_bar(walk, reconstruct, capfd):
    reconstruct(plant_feet=True)

    message = capfd.readouterr().out.strip().splitlines()[-1].removeprefix("Info: ")
    assert len(message) < 100
    assert (
        message.startswith("walk.reconstructed: rebuilt 6.") and "% of joint samples" in message
    )
    assert "Slide on the floor" in message and message.endswith(" cm.")


def test_button_is_disabled_without_an_armature(blank):
    blank.ops.object.empty_add()

    with pytest.raises(RuntimeError, match="Select an animated armature"):
        blank.ops.mocap_assist.reconstruct()


@pytest.fixture
def keys_of():
    """All keys of an action."""

    def read(action):
        return {
            (curve.data_path, curve.array_index): [
                tuple(key.co) for key in curve.keyframe_points
            ]
            for curve in action.layers[0].strips[0].channelbags[0].fcurves
        }

    return read
