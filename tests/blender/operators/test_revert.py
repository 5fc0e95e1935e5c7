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


def test_revert_removes_a_result_that_was_cut_and_keeps_its_action(noisy, clean, load):
    clean(result_as="NLA_TRACK")
    (track,) = noisy.animation_data.nla_tracks
    result = track.strips[0].action
    track.strips.new("second half", 101, result).action_slot = result.slots[0]
    result.use_fake_user = False

    message = load("mocap_assist.check.reverting").revert_to_recorded(noisy)

    assert not noisy.animation_data.nla_tracks and result.use_fake_user
    assert noisy.animation_data.action.name == RAW and "Other" not in message


def hand_edited_copy(track):
    (strip,) = track.strips
    strip.action = strip.action.copy()
    strip.action.name, strip.action.use_fake_user = "hand edits", False
    strip.action_slot = strip.action.slots[0]


def locked_track(track):
    track.lock = True


def additive_strip(track):
    track.strips[0].blend_type, track.strips[0].influence = "ADD", 0.3


def montage(track):
    """Trimmed strips on a track of the animator."""
    action = track.strips[0].action
    track.name = "montage"
    track.strips[0].action_frame_end = 20.0
    track.strips.new("again", 101, action).action_slot = action.slots[0]


@pytest.mark.parametrize("change", [hand_edited_copy, locked_track, additive_strip, montage])
def test_strips_of_the_animator_stay_and_play_as_before(noisy, clean, load, change):
    """They were removed, and a hand-edited copy was gone with the next save."""
    clean(result_as="NLA_TRACK")
    (track,) = noisy.animation_data.nla_tracks
    change(track)
    before = [(each.action, each.frame_start, each.frame_end) for each in track.strips]

    clean()
    message = load("mocap_assist.check.reverting").revert_to_recorded(noisy)

    assert [
        (each.action, each.frame_start, each.frame_end)
        for track in noisy.animation_data.nla_tracks
        for each in track.strips
    ] == before
    assert "Other NLA strips stay and play results." in message


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
def test_new_result_plays_on_the_strip_of_the_one_before(noisy, clean, blank, output):
    """Also where the strip was moved and scaled: the shot around it fits to that."""
    clean(result_as="NLA_TRACK")
    (track,) = noisy.animation_data.nla_tracks
    (strip,) = track.strips
    strip.scale, strip.frame_start_raw, strip.frame_end_raw = 2.0, 51.0, 169.0
    blank.data.actions[CLEAN].use_fake_user = False

    assert clean(result_as=output) is None

    (track,) = noisy.animation_data.nla_tracks
    (strip,) = track.strips
    assert track.name == strip.name == strip.action.name == f"{CLEAN}.001"
    assert strip.action_slot == strip.action.slots[0]
    assert (strip.frame_start, strip.frame_end, strip.scale) == (51.0, 169.0, 2.0)
    assert blank.data.actions[CLEAN].use_fake_user


def test_muted_track_is_not_the_played_action(noisy, clean, blank):
    clean(result_as="NLA_TRACK")
    noisy.animation_data.nla_tracks[0].mute = True

    with pytest.raises(RuntimeError, match="Actor has no action"):
        blank.ops.mocap_assist.revert_to_raw()


def test_linked_result_is_not_reverted_but_its_raw_action_is_shown(
    noisy, clean, blank, load, tmp_path
):
    clean(result_as="NLA_TRACK")
    noisy.animation_data.nla_tracks[0].strips[0].scale = 2.0
    path, name = str(tmp_path / "linked.blend"), noisy.name
    blank.ops.wm.save_as_mainfile(filepath=path)
    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with blank.data.libraries.load(path, link=True) as (_, loaded):
        loaded.objects = [name]
    (linked,) = loaded.objects
    blank.context.scene.collection.objects.link(linked)
    blank.context.view_layer.objects.active = linked
    raw_view = load("mocap_assist.check.raw_view")

    assert "linked from" in load("mocap_assist.check.reverting").why_not_revert(blank.context)
    assert not raw_view.why_not_show_raw(blank.context)
    raw_view.show_raw(blank.context)
    tracks = linked.animation_data.nla_tracks
    assert tracks[-1].strips[0].action.name == RAW
    raw_view.restore_played()
    assert [track.name for track in tracks] == [CLEAN]
