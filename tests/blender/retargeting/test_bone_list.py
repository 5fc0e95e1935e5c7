"""The editable list of bones, its presets, and the panel around it."""

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose


@pytest.fixture
def listed(walker, make_rig, blank):
    """The list, filled for a walker and an Unreal rig."""
    target = make_rig("Unreal", lowered=0.8)
    blank.context.view_layer.objects.active = walker
    blank.context.scene.mocap_assist.retarget.target = target.name
    assert blank.ops.mocap_assist.find_bones() == {"FINISHED"}
    return blank.context.scene.mocap_assist.bone_map


def test_find_bones_fills_a_row_for_each_role_with_a_score(listed):
    pairs = {row.name: (row.source, row.target) for row in listed.rows}

    assert pairs["leftUpperArm"] == ("LeftArm", "upperarm_l")
    assert pairs["hips"] == ("Hips", "pelvis")
    assert listed.source_score > 0.9 and listed.target_score > 0.9


def test_the_score_follows_an_edited_bone(listed):
    source = listed.source_score
    row = next(row for row in listed.rows if row.name == "leftLowerLeg")
    bone, row.target = row.target, "hand_l"

    assert listed.target_score < 0.95
    assert listed.source_score == source

    row.target = bone
    assert listed.target_score == 1.0


@pytest.mark.parametrize("wide", [False, True])
def test_columns_have_headings(listed, load, draw, monkeypatch, wide):
    monkeypatch.setattr(load("mocap_assist.retarget.bone_list"), "is_wide", lambda _: wide)

    shown = draw("MOCAP_PT_retarget")

    assert {"Source", "Target"} <= set(shown) and ("Body Parts" in shown) == wide


def test_a_narrow_list_names_the_role_where_the_source_lacks_a_bone(listed, load, draw):
    assert "Lower Leg L" not in draw("MOCAP_PT_retarget")

    next(row for row in listed.rows if row.name == "leftLowerLeg").source = ""

    assert draw("MOCAP_PT_retarget").count("Lower Leg L") == 1


def test_retarget_uses_the_list(listed, walker, give, blank, keys_of):
    target = blank.context.scene.objects["Unreal"]
    next(row for row in listed.rows if row.name == "head").target = ""

    keyed = {path.split('"')[1] for _, path, _ in keys_of(give(walker, target))}

    assert "head" not in keyed and "neck_01" in keyed


def test_list_of_other_armatures_is_ignored(listed, walker, give, make_rig, keys_of):
    next(row for row in listed.rows if row.name == "head").target = ""
    other = make_rig("Mixamo")

    keyed = {path.split('"')[1] for _, path, _ in keys_of(give(walker, other))}

    assert "Head" in keyed


def test_preset_restores_the_saved_list(listed, blank, tmp_path, walker, give, keys_of):
    row = next(row for row in listed.rows if row.name == "neck")
    row.target = "neck_02"
    path = str(tmp_path / "unreal.json")

    assert blank.ops.mocap_assist.save_bone_map(filepath=path, side="target") == {"FINISHED"}
    blank.ops.mocap_assist.find_bones()
    assert next(row for row in listed.rows if row.name == "neck").target == "neck_01"
    assert blank.ops.mocap_assist.load_bone_map(filepath=path, side="target") == {"FINISHED"}
    assert next(row for row in listed.rows if row.name == "neck").target == "neck_02"

    blank.ops.mocap_assist.find_bones()
    target = blank.context.scene.objects["Unreal"]
    keyed = keys_of(give(walker, target, target_map_file=path))
    assert any("neck_02" in path for _, path, _ in keyed)


def test_invalid_presets_are_refused_in_one_sentence(listed, blank, tmp_path):
    bad = tmp_path / "bad.json"
    bad.write_text("{}")

    with pytest.raises(RuntimeError, match="not a humanoid map"):
        blank.ops.mocap_assist.load_bone_map(filepath=str(bad), side="source")
    with pytest.raises(RuntimeError, match="There is no file"):
        blank.ops.mocap_assist.load_bone_map(filepath=str(tmp_path / "no"), side="source")


def test_presets_are_stored_in_the_user_folder(load, extension):
    folder = load("mocap_assist.retarget.bone_list").preset_folder()

    assert folder.is_dir() and "bl_ext" not in str(folder)
    assert folder.name == "bone_maps" and ".user" in folder.parts


def test_panel_shows_missing_input(walker, blank, load, make_rig):
    why = load("mocap_assist.retarget.panel").why_not_pressed
    shown = blank.context.scene.mocap_assist.retarget

    assert "Choose the target armature" in why(blank.context)
    shown.target = walker.name
    assert "is the source itself" in why(blank.context)
    shown.target = "Nobody"
    assert "no armature Nobody" in why(blank.context)
    target = make_rig("Mixamo")
    blank.context.view_layer.objects.active = walker
    shown.target = target.name
    assert why(blank.context) == ""
    blank.context.view_layer.objects.active = None
    assert "Select the source armature" in why(blank.context)


def test_actions_can_be_selected_and_deselected(walker, blank):
    shown = blank.context.scene.mocap_assist.retarget
    name = walker.animation_data.action.name

    blank.ops.mocap_assist.tick_action(action=name)
    assert shown.actions == name
    blank.ops.mocap_assist.tick_action(action=name)
    assert shown.actions == ""


def test_each_bone_has_a_confidence_and_a_reason(listed):
    row = next(row for row in listed.rows if row.name == "leftLowerLeg")

    assert (row.source, row.source_reason) == ("LeftLeg", "by name and structure")
    assert row.source_confidence > 0.9
    assert row.target_confidence > 0.5 and row.target_reason


def test_a_wrong_bone_is_marked_with_its_reason(listed, draw, load):
    row = next(row for row in listed.rows if row.name == "leftLowerLeg")
    listed.active_row = list(listed.rows).index(row)
    assert "low confidence" not in " ".join(draw("MOCAP_PT_retarget"))

    row.source = "LeftHand"

    assert load("mocap_assist.retarget.bone_map").has_low_confidence(row, "source")
    drawn = " ".join(draw("MOCAP_PT_retarget"))
    assert "low confidence; click a row" in drawn
    assert "Source: 10%, neither name nor structure suggests it." in drawn


def test_retarget_reports_bones_with_low_confidence(listed, walker, give, blank, capsys):
    rows = {row.name: row for row in listed.rows}
    rows["leftShoulder"].source = ""
    rows["neck"].source = "LeftShoulder"

    entry = give(walker, blank.context.scene.objects["Unreal"])

    assert "Bones with low confidence: LeftShoulder as neck" in capsys.readouterr().out
    assert "LeftShoulder as neck" in entry["mocap_assist_history"]


@pytest.mark.parametrize(
    ("bone", "reason"),
    [("Spine", "another row has this bone, so this one is ignored"),
     ("Nobody", "the armature has no such bone")],
)  # fmt: skip
def test_a_bone_without_effect_is_marked(listed, load, bone, reason):
    row = next(row for row in listed.rows if row.name == "leftShoulder")

    row.source = bone

    assert row.source_reason == reason
    assert load("mocap_assist.retarget.bone_map").has_low_confidence(row, "source")


def test_roles_have_readable_and_different_names(load):
    label_of = load("mocap_assist.retarget.role_labels").role_label
    labels = {role: label_of(role) for role in load("solvers.motion").HUMANOID_ROLES}

    assert labels["leftUpperLeg"] == "Upper Leg L"
    assert labels["rightThumbMetacarpal"] == "Thumb 1 R"
    assert labels["leftLittleDistal"] == "Little Finger 3 L"
    assert len(set(labels.values())) == len(labels)
    assert label_of("leftTail") == "leftTail"


@pytest.fixture
def highlight(load):
    return load("mocap_assist.retarget.bone_highlight")


def test_click_on_a_row_selects_and_highlights_both_bones(listed, walker, blank, highlight):
    target = blank.context.scene.objects["Unreal"]
    index = [row.name for row in listed.rows].index("leftUpperArm")

    listed.active_row = index

    assert blank.context.window_manager.mocap_assist_highlight
    for armature, bone in ((walker, "LeftArm"), (target, "upperarm_l")):
        assert armature.data.bones.active.name == bone
    (source, line), (other, _) = highlight.highlighted_bones(blank.context)
    assert (source, other) == (walker, target)
    assert line[0, 0] == pytest.approx(walker.pose.bones["LeftArm"].head)

    blank.context.view_layer.objects.active = None
    assert not highlight.highlighted_bones(blank.context)

    blank.context.window_manager.mocap_assist_highlight = False
    listed.active_row = 0
    assert not blank.context.window_manager.mocap_assist_highlight
    blank.context.window_manager.mocap_assist_highlight = True


@pytest.mark.parametrize(("is_open", "tab", "is_drawn"), [
    (True, "Mocap", True), (True, "Item", False), (False, "Mocap", False),
])  # fmt: skip
def test_highlight_is_drawn_while_the_tab_is_open(
    listed, blank, highlight, monkeypatch, is_open, tab, is_drawn
):
    """A pink bone without the list next to it is a riddle."""
    sidebar = SimpleNamespace(type="UI", active_panel_category=tab)
    space = SimpleNamespace(show_region_ui=is_open)
    area = SimpleNamespace(spaces=SimpleNamespace(active=space), regions=[sidebar])
    context = SimpleNamespace(
        window_manager=blank.context.window_manager,
        view_layer=blank.context.view_layer,
        scene=blank.context.scene,
        space_data=None,
        screen=SimpleNamespace(areas=[area]),
    )
    drawn = []
    monkeypatch.setattr(highlight, "highlighted_bones", lambda context: drawn.append(1) or [])

    highlight._draw(context)

    assert bool(drawn) is is_drawn


def test_row_without_a_bone_on_one_side_highlights_the_other(listed, blank, highlight):
    index = [row.name for row in listed.rows].index("head")
    listed.rows[index].target = ""

    listed.active_row = index

    ((armature, _),) = highlight.highlighted_bones(blank.context)
    assert armature.name == listed.source


def test_levels_differ_without_colors(load):
    names = ("color_icons", "marked_ranges")
    icons, ranges = (load(f"mocap_assist.overlays.{name}") for name in names)

    levels = [ranges.confidence_mark(each) for each in (0.4, 0.7, 0.8)]

    assert [each.name for each in levels] == ["LOW", "MEDIUM", "HIGH"]
    painted = [icons._bars((1.0, 1.0, 1.0, 1.0), icons.BARS[each]) for each in levels]
    lit = [int((each[..., 3] == 1.0).sum()) for each in painted]
    assert lit[0] < lit[1] < lit[2]


def test_rest_poses_of_both_rigs_fill_their_boxes(listed, load, blank, walker):
    preview = load("mocap_assist.retarget.rest_preview")
    blank.context.scene.frame_set(20)

    source, target = preview.rest_figures(blank.context)

    for figure in (source, target):
        box = preview.Box(10.0, 20.0, 240.0, 240.0)
        front = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
        points = preview.lines_in_box(figure.lines, front, box).reshape(-1, 2)
        assert all(box.has(*point) for point in points)
        assert np.ptp(points, axis=0).max() > 0.5 * box.width
        head = np.argmax(figure.lines.reshape(-1, 3)[:, 2])
        assert points[head, 1] == points[:, 1].max()
    bones = list(walker.data.bones)
    hips = next(index for index, bone in enumerate(bones) if bone.name == "Hips")
    matrix = walker.matrix_world
    assert_allclose(source.lines[hips, 0], matrix @ bones[hips].head_local, atol=1e-6)
    assert source.colors[hips] == preview.HIGHLIGHT  # the first row
    assert (source.name, target.name) == (walker.name, "Unreal")

    blank.context.view_layer.objects.active = None
    assert preview.rest_figures(blank.context) == []


def test_rig_without_a_bone_to_draw_has_no_rest_pose(listed, load, blank):
    preview = load("mocap_assist.retarget.rest_preview")
    assert len(preview.rest_figures(blank.context)) == 2
    for row in listed.rows:
        row.target = ""
    for bone in blank.context.scene.objects["Unreal"].data.bones:
        bone.use_deform = False

    assert preview.rest_figures(blank.context) == []
