"""What becomes of variants: picked, given to a crowd, strips, assets, a contact sheet."""

import numpy as np
import pytest


@pytest.fixture
def variants(vary, blank):
    """The list of four variants."""
    vary()
    return blank.context.scene.mocap_assist.variants


@pytest.fixture
def crowd(blank, variants, walker):
    """The walker and four more of its kind, all selected."""
    members = [walker]
    for _ in range(4):
        member = walker.copy()
        member.animation_data_clear()
        member.location.x += 2.0 * len(members)
        blank.context.scene.collection.objects.link(member)
        members.append(member)
    for member in members:
        member.select_set(True)
    return members


def test_clicked_variant_plays_and_each_has_a_preview(variants, walker):
    assert [row.name for row in variants.rows] == [f"walk_1.variant 0{n}" for n in (1, 2, 3, 4)]
    for index in (2, 0, 3):
        variants.active = index
        assert walker.animation_data.action == variants.rows[index].action
        assert walker.animation_data.action_slot is not None
    pictures = []
    for row in variants.rows:
        preview = row.action.preview
        pixels = np.empty(4 * preview.image_size[0] * preview.image_size[1], np.float32)
        preview.image_pixels_float.foreach_get(pixels)
        pictures.append(pixels)
    assert len({picture.tobytes() for picture in pictures}) == 4


def test_keep_picked_deletes_unused_others(variants, walker, blank):
    assert not blank.ops.mocap_assist.keep_variants.poll()
    other = blank.data.objects.new("Other", walker.data)
    other.animation_data_create().action = variants.rows[3].action
    variants.rows[1].picked = True

    assert blank.ops.mocap_assist.keep_variants() == {"FINISHED"}

    left = [each.name for each in blank.data.actions if ".variant" in each.name]
    assert left == ["walk_1.variant 02", "walk_1.variant 04"]
    assert [row.name for row in variants.rows] == ["walk_1.variant 02"]
    assert walker.animation_data.action.name == "walk_1.variant 02"


def placements(crowd):
    return [
        (
            [strip.action.name for track in each.animation_data.nla_tracks
             for strip in track.strips],
            each.animation_data.nla_tracks[-1].strips[0].frame_start,
            tuple(each.delta_location), each.delta_rotation_euler.z,
        )
        for each in crowd
    ]  # fmt: skip


def test_crowd_delays_and_offsets_repeat_for_the_same_seed(crowd, blank, walker, poses):
    where = [tuple(each.location) for each in crowd]
    settings = {"delay": 2.0, "spread": 0.5, "turn": 0.3}

    assert blank.ops.mocap_assist.assign_variants(**settings) == {"FINISHED"}

    first = placements(crowd)
    played = [strips[-1] for strips, *_ in first]
    assert len(set(played[:4])) == 4 and played[4] in played[:4]
    starts = [start for _, start, *_ in first]
    assert len(set(starts)) > 2 and all(1 <= start <= 61 for start in starts)
    shifts = [np.hypot(*location[:2]) for *_, location, _ in first]
    assert len(set(shifts)) == 5 and max(shifts) <= 0.5
    assert [tuple(each.location) for each in crowd] == where
    assert not np.allclose(*(poses(crowd[1], [frame])["Hips"][0] for frame in (70, 80)))
    blank.context.scene.frame_set(1)
    for seed, same in ((0, True), (1, False), (0, True)):
        blank.ops.mocap_assist.assign_variants(crowd_seed=seed, **settings)
        assert (placements(crowd) == first) == same
    blank.ops.mocap_assist.assign_variants(delay=0.0, spread=0.0, turn=0.0)
    assert all(
        location == (0.0, 0.0, 0.0) and heading == 0.0
        for *_, location, heading in placements(crowd)
    )


def test_assign_refuses_armatures_with_other_bones(crowd, make_armature, blank):
    stranger = make_armature(bones={"Wheel": (None, (0, 0, 0), (0, 0, 1), False)}, name="Car")
    stranger.select_set(True)

    with pytest.raises(RuntimeError, match="Car lacks the bones of walk_1"):
        blank.ops.mocap_assist.assign_variants()

    assert crowd[1].animation_data is None


def test_strips_are_placed_one_after_another(variants, walker, blank):
    for index in (0, 2):
        variants.rows[index].picked = True
    blank.context.scene.frame_set(10)

    assert blank.ops.mocap_assist.stack_variants() == {"FINISHED"}

    strips = [track.strips[0] for track in walker.animation_data.nla_tracks]
    assert [strip.action.name[-2:] for strip in strips] == ["01", "03"]
    assert strips[0].frame_start == 10 and strips[1].frame_start > strips[0].frame_end
    assert walker.animation_data.action is None


def test_variants_become_assets_with_tags_and_a_contact_sheet(variants, blank, tmp_path):
    variants.rows[2].picked = True
    blank.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))

    assert blank.ops.mocap_assist.mark_variants(tags="crowd", catalog="Walks") == {"FINISHED"}
    sheet = tmp_path / "sheet.png"
    assert blank.ops.mocap_assist.draw_variants(filepath=str(sheet)) == {"FINISHED"}

    assets = [each for each in blank.data.actions if each.asset_data is not None]
    assert [each.name for each in assets] == ["walk_1.variant 03"]
    assert {tag.name for tag in assets[0].asset_data.tags} == {"variant", "crowd"}
    assert "Walks" in (tmp_path / "blender_assets.cats.txt").read_text()
    assert 100 < blank.data.images.load(str(sheet)).size[1] < 350  # one row
    with pytest.raises(RuntimeError, match="There is no folder"):
        blank.ops.mocap_assist.draw_variants(filepath=str(tmp_path / "no" / "sheet.png"))
    for path in ("", "//", "/"):
        with pytest.raises(RuntimeError, match=r"Choose the \.png file to write") as refusal:
            blank.ops.mocap_assist.draw_variants(filepath=path)
        assert "Traceback" not in str(refusal.value)


def test_saved_file_keeps_the_list_and_previews(variants, blank, tmp_path):
    blank.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    blank.ops.wm.open_mainfile(filepath=str(tmp_path / "shot.blend"))

    rows = blank.context.scene.mocap_assist.variants.rows
    assert [row.action.name for row in rows][:1] == ["walk_1.variant 01"]
    assert tuple(rows[3].action.preview.image_size) == (128, 128)


def test_panel_shows_variants_and_missing_input(blank, draw, walker, vary):
    shown = draw("MOCAP_PT_vary")
    assert "mocap_assist.vary" in shown and "mocap_assist.keep_variants" not in shown

    vary(n_variants=2)

    shown = draw("MOCAP_PT_vary")
    assert {"mocap_assist.keep_variants", "mocap_assist.draw_variants", "icon"} <= set(shown)
    assert {"variant 01", "variant 02", "Apply to all 2:"} <= set(shown)
    blank.ops.mocap_assist.tick_action(action="walk_2", group="vary")
    assert blank.context.scene.mocap_assist.vary.actions == "walk_2"
    blank.data.objects.remove(walker)
    assert "Select the armature whose actions to vary." in " ".join(draw("MOCAP_PT_vary"))


def test_tick_of_an_action_that_fits_no_more_is_shown_and_can_be_removed(blank, draw, walker):
    """Vary refuses it: it was renamed, deleted, or is of another armature."""
    group, action = blank.context.scene.mocap_assist.vary, walker.animation_data.action
    former, n_ticks = action.name, draw("MOCAP_PT_vary").count("mocap_assist.tick_action")
    blank.ops.mocap_assist.tick_action(action=former, group="vary")
    action.name = "renamed"

    shown = draw("MOCAP_PT_vary")

    assert f"There is no action {former} with keys" in " ".join(shown)
    assert shown.count("mocap_assist.tick_action") == n_ticks + 1
    blank.ops.mocap_assist.tick_action(action=former, group="vary")
    assert not group.actions and blank.ops.mocap_assist.vary.poll()
    assert draw("MOCAP_PT_vary").count("mocap_assist.tick_action") == n_ticks


@pytest.mark.parametrize("number", [-5, 10**8])
def test_panel_accepts_an_index_stored_by_another_version(blank, draw, walker, number):
    group = blank.context.scene.mocap_assist.vary
    getattr(group, "bl_system_properties_get", lambda: group)()["n_variants"] = number
    group.actions = "walk_1"

    assert "mocap_assist.vary" in draw("MOCAP_PT_vary")
    assert blank.ops.mocap_assist.vary.poll()
    assert 1 <= group.settings().choices.n_variants <= 1000


def test_panel_does_not_read_variants(vary, draw, load, monkeypatch):
    retargeting, looks = load("mocap_assist.retarget.scene_retargeting"), []
    look = retargeting.animated_paths

    def counted(action, slot):
        for path in look(action, slot):
            looks.append(action.name)
            yield path

    monkeypatch.setattr(retargeting, "animated_paths", counted)
    vary(n_variants=12)
    looks.clear()

    draw("MOCAP_PT_vary")

    assert set(looks) == {"walk_1", "walk_2", "walk_3"}
    assert len(looks) < 20  # the first channel of a bone is enough
