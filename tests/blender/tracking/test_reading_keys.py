"""What Track from Here reads of an action: where it plays, and which keys are of the take."""

import pytest

ARM = "rightUpperArm"


@pytest.fixture
def made(write_tracked, blank):
    made = write_tracked(step=0.8)
    blank.context.scene.frame_set(5)
    return made


@pytest.fixture
def why_grey(load, blank):
    why_not = load("mocap_assist.retracking").why_not_retrack
    return lambda: why_not(blank.context)


@pytest.fixture
def strip(made, load):
    """Let a result play on an NLA track, as Clean does it."""
    write, history = (
        load("mocap_assist.scene.armature_write"),
        load("mocap_assist.scene.history"),
    )
    result = write.copy_of(made.source[0])
    slot = write.same_slot(result, made.source[1])
    history.record(result, made.source, {"operation": "clean"})
    write.put_to_use(made.armature, result, slot, write.Output.NLA_TRACK)
    ((strip,),) = (track.strips for track in made.armature.animation_data.nla_tracks)
    return strip


def test_a_result_on_an_nla_track_may_be_tracked_from(strip, why_grey):
    assert why_grey() == ""


@pytest.mark.parametrize("change", ["moved", "scaled", "reversed", "by a curve"])
def test_a_strip_that_plays_at_other_frames_is_refused(change, strip, made, why_grey, load):
    if change == "moved":
        strip.frame_start, strip.frame_end = 6.0, 21.2
    elif change == "scaled":
        strip.scale = 1.5
    elif change == "reversed":
        strip.use_reverse = True
    else:
        strip.use_animated_time = True
    sentence = "wall tracked.clean plays at other frames on its NLA strip"
    assert why_grey().startswith(sentence)
    retracking = load("mocap_assist.retracking")
    settings = retracking.RetrackBundle(load("solvers.depth_tracking").RetrackSettings())
    scene = made.armature.users_scene[0]
    with pytest.raises(load("solvers.errors").InvalidMotionError, match=sentence):
        retracking.read_retracking(scene, made.armature, settings)
