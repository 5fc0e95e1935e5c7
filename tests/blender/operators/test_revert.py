"""Revert to Raw: what it removes, and why it may be gray."""

import pytest

RAW, CLEAN = "walk", "walk.clean"


def test_revert_plays_the_raw_action_again_and_keeps_the_result(noisy, clean, blank):
    with pytest.raises(RuntimeError, match="walk is the raw action"):
        blank.ops.mocap_assist.revert_to_raw()
    raw, result = noisy.animation_data.action, clean()
    raw.name = "renamed by the animator"

    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}

    assert noisy.animation_data.action == raw
    assert noisy.animation_data.action_slot == raw.slots[0]
    assert result.use_fake_user


def test_revert_removes_every_result_from_the_nla_and_no_other_track(noisy, clean, blank):
    clean(result_as="NLA_TRACK")
    clean(result_as="NLA_TRACK")
    layer = noisy.animation_data.nla_tracks.new()
    layer.strips.new("layer", 1, blank.data.actions[RAW].copy())

    blank.ops.mocap_assist.revert_to_raw()

    assert noisy.animation_data.nla_tracks.values() == [layer]
    with pytest.raises(RuntimeError, match="walk is the raw action"):
        blank.ops.mocap_assist.revert_to_raw()


def test_revert_removes_each_strip_of_a_result_and_leaves_other_strips(noisy, clean, blank):
    """An animator may cut a result, and lay other motion on its track."""
    clean(result_as="NLA_TRACK")
    (track,) = noisy.animation_data.nla_tracks
    track.strips.new("second half", 101, track.strips[0].action)
    other = track.strips.new("other", 201, blank.data.actions[RAW].copy())

    blank.ops.mocap_assist.revert_to_raw()

    assert [each.strips.values() for each in noisy.animation_data.nla_tracks] == [[other]]
    assert noisy.animation_data.action.name == RAW


@pytest.mark.usefixtures("all_panels")
def test_compare_says_why_nothing_can_be_reverted(noisy, clean, blank, draw):
    hint = "walk is the raw action. Press Fix My Take or Clean first."
    texts = draw("MOCAP_PT_compare")
    assert "mocap_assist.revert_to_raw" in texts and hint in " ".join(texts)
    clean()
    assert hint not in " ".join(draw("MOCAP_PT_compare"))

    blank.data.actions.remove(blank.data.actions[RAW])

    texts = " ".join(draw("MOCAP_PT_compare"))
    assert "The raw action of walk.clean is not in this file." in texts


def test_result_in_tweak_mode_is_not_reverted_and_the_button_says_why(noisy, clean, blank):
    """Blender locks the action then."""
    clean(result_as="NLA_TRACK")
    animation = noisy.animation_data
    animation.nla_tracks.active = animation.nla_tracks[0]
    animation.nla_tracks[0].strips[0].select = True
    animation.use_tweak_mode = True

    with pytest.raises(RuntimeError, match="Actor is in tweak mode, which locks its action"):
        blank.ops.mocap_assist.revert_to_raw()

    animation.use_tweak_mode = False
    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}


@pytest.mark.parametrize("output", ["ACTION", "NLA_TRACK"])
def test_new_result_replaces_the_strip_of_the_one_before(noisy, clean, blank, output):
    clean(result_as="NLA_TRACK")

    action = clean(result_as=output)

    tracks = noisy.animation_data.nla_tracks
    names = [strip.action.name for track in tracks for strip in track.strips]
    assert (action and action.name, names) == (
        (f"{CLEAN}.001", []) if output == "ACTION" else (None, [f"{CLEAN}.001"])
    )
    assert blank.data.actions[CLEAN].use_fake_user


def test_muted_track_is_not_the_played_action(noisy, clean, blank):
    clean(result_as="NLA_TRACK")
    noisy.animation_data.nla_tracks[0].mute = True

    with pytest.raises(RuntimeError, match="Actor has no action"):
        blank.ops.mocap_assist.revert_to_raw()
