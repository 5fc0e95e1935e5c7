"""A jump shows the issue as the switches choose."""

from types import SimpleNamespace

import pytest
from mathutils import Matrix, Vector


@pytest.fixture
def switches(blank):
    """The window manager, with both switches as at first when the test ends."""
    manager = blank.context.window_manager
    yield manager
    manager.mocap_assist_issue_view, manager.mocap_assist_issue_range = True, False


@pytest.fixture
def issue(blank, actor):
    """An issue of one bone; it is the only one in the list."""
    made = blank.context.scene.mocap_assist.issues.add()
    made.name, made.start, made.stop, made.kind = "LeftArm", 20.0, 22.0, "gap"
    return made


def preview(scene):
    return scene.use_preview_range and (scene.frame_preview_start, scene.frame_preview_end)


def test_preview_range_has_four_frames_around_an_issue_while_its_switch_is_on(
    blank, switches, issue
):
    scene = blank.context.scene
    blank.ops.mocap_assist.jump_to_issue(index=0)
    assert not preview(scene)

    switches.mocap_assist_issue_range = True
    assert preview(scene) == (16, 26)
    issue.start = 30.0
    issue.stop = 30.0
    blank.ops.mocap_assist.jump_to_issue(index=0)
    assert preview(scene) == (26, 34)

    switches.mocap_assist_issue_range = False
    assert not preview(scene)

    scene.use_preview_range, scene.frame_preview_start, scene.frame_preview_end = True, 5, 9
    switches.mocap_assist_issue_range = True
    assert preview(scene) == (26, 34)
    switches.mocap_assist_issue_range = False
    assert preview(scene) == (5, 9)


def test_issues_leave_the_range_that_was_dragged_for_clean(blank, switches, issue):
    scene = blank.context.scene
    switches.mocap_assist_issue_range = True
    assert preview(scene) == (16, 26)

    blank.ops.mocap_assist.set_range(start=5, end=50)
    blank.ops.mocap_assist.jump_to_issue(index=0)
    assert preview(scene) == (5, 50)
    switches.mocap_assist_issue_range = False
    assert preview(scene) == (5, 50)

    switches.mocap_assist_issue_range = True
    assert preview(scene) == (5, 50)
    blank.ops.mocap_assist.set_range()
    blank.ops.mocap_assist.jump_to_issue(index=0)
    assert preview(scene) == (16, 26)


def test_range_that_the_animator_sets_between_issues_is_restored(blank, switches, issue):
    scene = blank.context.scene
    switches.mocap_assist_issue_range = True
    issue.start = issue.stop = 30.0
    blank.ops.mocap_assist.jump_to_issue(index=0)
    scene.frame_preview_start, scene.frame_preview_end = 16, 26  # as undo does
    switches.mocap_assist_issue_range = False
    assert not preview(scene)

    switches.mocap_assist_issue_range = True
    scene.frame_preview_start, scene.frame_preview_end = 2, 7
    blank.ops.mocap_assist.jump_to_issue(index=0)
    assert preview(scene) == (26, 34)

    switches.mocap_assist_issue_range = False

    assert preview(scene) == (2, 7)


@pytest.mark.parametrize(("x", "is_moved"), [(0.5, False), (0.95, True), (3.0, True)])
def test_view_moves_only_to_a_point_that_it_does_not_show(load, x, is_moved):
    view = SimpleNamespace(
        view_perspective="ORTHO", perspective_matrix=Matrix.Identity(4), view_location=None
    )
    area = SimpleNamespace(
        type="VIEW_3D",
        spaces=SimpleNamespace(active=SimpleNamespace(region_3d=view)),
        tag_redraw=lambda: None,
    )
    window = SimpleNamespace(screen=SimpleNamespace(areas=[area]))
    point = Vector((x, 0.0, 0.0))

    load("mocap_assist.overlays.view_control").show_point(
        SimpleNamespace(windows=[window]), point
    )

    assert view.view_location == (point if is_moved else None)


def test_point_behind_a_view_is_not_shown(load):
    behind = Matrix(((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, -1, 0)))

    assert not load("mocap_assist.overlays.view_control").is_in_view(behind, Vector((0, 0, 1)))


def test_jump_shows_the_bone_in_the_scene(blank, switches, issue, actor, load, monkeypatch):
    views, points = load("mocap_assist.check.issue_views"), []
    monkeypatch.setattr(views, "show_point", lambda _, point: points.append(point))
    actor.location = (5.0, 0.0, 0.0)

    blank.ops.mocap_assist.jump_to_issue(index=0)

    blank.context.view_layer.update()
    (point,) = points
    assert point == actor.matrix_world @ actor.pose.bones["LeftArm"].head
    switches.mocap_assist_issue_view = False
    blank.ops.mocap_assist.jump_to_issue(index=0)
    assert len(points) == 1


@pytest.mark.usefixtures("all_panels")
def hide_bone(bpy, armature, bone):
    (bone.bone if bpy.app.version < (5, 0) else bone).hide = True


def hide_collection(bpy, armature, bone):
    collection = armature.data.collections.new("Helpers")
    collection.assign(bone.bone)
    collection.is_visible = False


def hide_armature(bpy, armature, bone):
    armature.hide_set(True)


@pytest.mark.parametrize(
    ("hide", "name"),
    [(hide_bone, "LeftArm"), (hide_collection, "LeftArm"), (hide_armature, None)],
)
def test_panel_says_why_the_bone_of_an_issue_is_not_visible(
    blank, draw, actor, issue, hide, name
):
    sentence = f"{name or actor.name} is hidden."
    assert sentence not in " ".join(draw("MOCAP_PT_check"))

    hide(blank, actor, actor.pose.bones["LeftArm"])
    assert blank.ops.mocap_assist.jump_to_issue(index=0) == {"FINISHED"}

    assert sentence in " ".join(draw("MOCAP_PT_check"))
    assert actor.mode == ("POSE" if name else "OBJECT")


def test_list_and_strip_name_the_kind_of_an_issue(blank, draw, actor, issue, load):
    blank.context.scene.mocap_assist.checked_action = actor.animation_data.action

    assert {"mocap_assist_issue_view", "mocap_assist_issue_range"} <= set(
        draw("MOCAP_PT_check")
    )
    strip = load("mocap_assist.overlays.strip.reading").strip_of(blank.context)
    assert [row.value for row in strip.rows] == ["Gaps"]


def test_panel_says_that_a_checked_take_has_no_issues(blank, draw, actor):
    assert "No issues found." not in draw("MOCAP_PT_check")
    blank.context.scene.mocap_assist.checked_action = actor.animation_data.action

    assert "No issues found." in draw("MOCAP_PT_check")

    blank.context.scene.mocap_assist.checked_action = blank.data.actions.new("another action")
    assert "No issues found." not in draw("MOCAP_PT_check")


@pytest.mark.usefixtures("all_panels")
def test_list_follows_a_renamed_action_and_names_a_deleted_one(blank, draw, actor, issue):
    def shown():
        return " ".join(draw("MOCAP_PT_check"))

    scene, raw = blank.context.scene, actor.animation_data.action
    scene.mocap_assist.checked_action = raw
    raw.name = "renamed by the animator"
    assert "Run Check again." not in shown()

    other = blank.data.actions.new("another action")
    scene.mocap_assist.checked_action = other
    assert 'Results are for "another action". Run Check again.' in shown()

    blank.data.actions.remove(other)
    assert "Results are for another action. Run Check again." in shown()
