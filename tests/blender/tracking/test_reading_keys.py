"""What Track from Here reads of an action: where it plays, and which keys are of the take."""

import numpy as np
import pytest

ARM = "rightUpperArm"


@pytest.fixture
def made(write_tracked, blank):
    made = write_tracked(step=0.8)
    blank.context.scene.frame_set(5)
    return made


@pytest.fixture
def why_gray(load, blank):
    why_not = load("mocap_assist.track.retracking").why_not_retrack
    return lambda: why_not(blank.context)


@pytest.fixture
def strip(made, load):
    """Let a result play on an NLA track, as Clean does it."""
    write, history = (
        load("mocap_assist.actions.armature_write"),
        load("mocap_assist.scene.history"),
    )
    result = write.copy_of(made.source[0])
    slot = write.same_slot(result, made.source[1])
    history.record(result, made.source, {"operation": "clean"})
    write.assign_result(made.armature, result, slot, write.Output.NLA_TRACK)
    ((strip,),) = (track.strips for track in made.armature.animation_data.nla_tracks)
    return strip


def test_result_on_an_nla_track_can_be_retracked(strip, why_gray):
    assert why_gray() == ""


@pytest.mark.parametrize("change", ["moved", "scaled", "reversed", "by a curve"])
def test_shifted_strip_is_refused(change, strip, made, why_gray, load):
    if change == "moved":
        strip.frame_start, strip.frame_end = 6.0, 21.2
    elif change == "scaled":
        strip.scale = 1.5
    elif change == "reversed":
        strip.use_reverse = True
    else:
        strip.use_animated_time = True
    sentence = "The NLA strip of wall tracked.clean does not match its frames"
    assert why_gray().startswith(sentence)
    retracking = load("mocap_assist.track.retracking")
    settings = retracking.RetrackBundle(load("solvers.depth_tracking").RetrackSettings())
    scene = made.armature.users_scene[0]
    with pytest.raises(load("solvers.errors").InvalidMotionError, match=sentence):
        retracking.read_retracking(scene, made.armature, settings)


@pytest.fixture
def curves(made, load):
    """The F-Curves of a property of a bone."""
    bag = load("mocap_assist.blender.compat").channelbag(*made.source)

    def curves(bone, name):
        path = f'pose.bones["{bone}"].{name}'
        return [curve for curve in bag.fcurves if curve.data_path == path]

    return curves


@pytest.fixture
def refused(made, read_take, load):
    """Expect a sentence."""

    def refused(sentence):
        with pytest.raises(load("solvers.errors").InvalidMotionError, match=sentence):
            read_take(made)

    return refused


def test_bones_without_rotation_keys_are_named(made, refused):
    for bone in (ARM, "hips"):
        made.armature.pose.bones[bone].rotation_mode = "XYZ"
    refused(f"hips, {ARM} of wall tracked")


@pytest.mark.parametrize("fault", ["muted", "cleared"])
def test_muted_and_empty_channels_are_no_keys(fault, curves, refused):
    curve = curves(ARM, "rotation_quaternion")[2]
    if fault == "muted":
        curve.mute = True
    else:
        curve.keyframe_points.clear()
    refused(f"{ARM} of wall tracked")


def test_hips_without_location_keys_are_named(made, curves, refused, load):
    bag = load("mocap_assist.blender.compat").channelbag(*made.source)
    bag.fcurves.remove(curves("hips", "location")[1])
    refused("hips of wall tracked")


def test_keys_of_other_channels_do_not_extend_the_take(made, read_take, blank):
    made.armature["mood"] = 1.0
    for frame in (-40, 300):
        made.armature.keyframe_insert('["mood"]', frame=frame)
    other = blank.data.objects.new("other", None)
    animation = other.animation_data_create()
    animation.action = made.source[0]
    animation.action_slot = made.source[0].slots.new("OBJECT", "other")
    other.keyframe_insert("location", frame=200)
    take = read_take(made, n_images=400)
    assert take.frames == pytest.approx(1.0 + 0.8 * np.arange(20)) and take.first == 0


def test_take_with_shifted_hip_keys_is_refused(curves, refused):
    for name in ("rotation_quaternion", "location"):
        for curve in curves("hips", name):
            for key in curve.keyframe_points:
                key.co.x += 500.0
            curve.update()
    refused("no keys within the recording")
