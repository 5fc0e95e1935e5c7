"""Issues become timeline markers on request, and are removed again; no others are."""

import pytest


@pytest.fixture
def scene(blank):
    """A scene with two listed issues and a marker of the animator."""
    scene = blank.context.scene
    for name, frame in (("LeftLeg", 12.4), ("Spine", 30.0)):
        issue = scene.mocap_assist.issues.add()
        issue.name, issue.start, issue.stop, issue.kind = name, frame, frame, "spike"
    scene.timeline_markers.new("cut", frame=5)
    return scene


def markers(scene):
    return sorted((each.frame, each.name) for each in scene.timeline_markers)


def test_each_issue_has_one_marker_however_often_pressed(blank, scene):
    for _ in range(2):
        assert blank.ops.mocap_assist.mark_issues() == {"FINISHED"}

    assert markers(scene) == [
        (5, "cut"), (12, "Issue: spike, LeftLeg"), (30, "Issue: spike, Spine"),
    ]  # fmt: skip


def test_markers_of_issues_are_removed_and_others_stay(blank, draw, scene):
    blank.ops.mocap_assist.mark_issues()
    scene.timeline_markers["Issue: spike, Spine"].name = "look here"
    scene.mocap_assist.issues.clear()

    assert blank.ops.mocap_assist.mark_issues(remove=True) == {"FINISHED"}

    assert markers(scene) == [(5, "cut"), (30, "look here")]
    assert not blank.ops.mocap_assist.mark_issues.poll()


@pytest.mark.usefixtures("all_panels")
def test_panel_offers_to_remove_what_is_there(blank, draw, scene):
    assert draw("MOCAP_PT_check").count("mocap_assist.mark_issues") == 1
    blank.ops.mocap_assist.mark_issues()
    assert draw("MOCAP_PT_check").count("mocap_assist.mark_issues") == 2

    scene.mocap_assist.issues.clear()
    assert draw("MOCAP_PT_check").count("mocap_assist.mark_issues") == 1
