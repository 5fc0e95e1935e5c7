"""Undo, redo and Revert leave the issues of what is played in the list of Check."""

from typing import NamedTuple

import pytest
from modal_events import event


def test_undo_after_a_quiet_check_points_to_no_freed_action(blank, actor):
    """The scene is the same before and after Clean in the steps, and is reused by undo."""
    shown, buttons = blank.context.scene.mocap_assist, blank.ops.mocap_assist
    played = actor.animation_data.action.name
    blank.ops.ed.undo_push(message="start")
    buttons.measure_quality("EXEC_DEFAULT", True)
    blank.ops.ed.undo_push(message="another step")
    buttons.denoise("EXEC_DEFAULT", True)
    buttons.measure_quality("EXEC_DEFAULT", True, is_quiet=True)
    assert shown.checked_action.name != played

    blank.ops.ed.undo()

    shown = blank.context.scene.mocap_assist
    assert [action.name for action in blank.data.actions] == [played]
    assert shown.checked_action in {None, blank.data.actions[played]}

    blank.ops.ed.redo()
    assert len(blank.data.actions) == 2


@pytest.fixture
def noisy(blank, load, monkeypatch):
    """Two seconds of the sample take, which has issues."""
    importing, walk = load("mocap_assist.importing.sample_take"), load("solvers.samples")
    monkeypatch.setattr(importing, "noisy_walk", lambda: walk.noisy_walk().slice(0, 60))
    blank.ops.mocap_assist.load_sample()


def test_undo_keeps_the_list_of_the_action_that_is_still_played(blank, noisy, renewing):
    """A check adds no undo step, so undo restored the list of before it, which was empty."""
    buttons = blank.ops.mocap_assist
    blank.ops.ed.undo_push(message="start")
    blank.context.scene.frame_set(9)
    blank.ops.ed.undo_push(message="another frame")
    buttons.measure_quality("EXEC_DEFAULT", True)
    before = state_of_list(blank)
    assert before.issues

    blank.ops.ed.undo()

    assert blank.context.scene.frame_current != 9
    assert state_of_list(blank) == before
    assert renewing.timers == [renewing.check_again]  # the keys may be others
    assert renewing._awaited == {blank.context.scene.session_uid: True}


def test_undo_checks_the_scene_of_the_window_again(blank, noisy, renewing):
    """Another scene, in which Check was pressed too, was awaited instead of it."""
    blank.ops.mocap_assist.measure_quality("EXEC_DEFAULT", True)
    blank.data.scenes.new("Scenes after it").mocap_assist.report = "Checked."
    blank.ops.ed.undo_push(message="start")
    blank.ops.ed.undo_push(message="another step")

    blank.ops.ed.undo()

    assert renewing._awaited == {blank.context.scene.session_uid: True}


def test_list_of_a_result_is_not_shown_for_the_recorded_action(blank, noisy, renewing):
    buttons = blank.ops.mocap_assist
    buttons.measure_quality("EXEC_DEFAULT", True)
    blank.ops.ed.undo_push(message="start")
    raw = state_of_list(blank)
    buttons.denoise("EXEC_DEFAULT", True, plant_feet=False)
    buttons.measure_quality("EXEC_DEFAULT", True)
    clean = state_of_list(blank)
    assert clean.issues != raw.issues
    renewing.timers.clear()

    blank.ops.ed.undo()

    assert state_of_list(blank) in {raw, ("", ())}
    assert renewing.timers == [renewing.check_again]


def test_undo_ends_a_check_of_what_was_played_before(blank, noisy, renewing, check, window):
    """It listed the issues of the result as those of the recorded action."""
    blank.ops.mocap_assist.measure_quality("EXEC_DEFAULT", True)
    blank.ops.ed.undo_push(message="start")
    blank.ops.mocap_assist.denoise("EXEC_DEFAULT", True, plant_feet=False)
    quiet = check(is_quiet=True)
    assert quiet.invoke(window.context, None) == {"RUNNING_MODAL"}
    renewing.bpy.context = window.context

    blank.ops.ed.undo()

    assert quiet.modal(window.context, event("TIMER")) == {"CANCELLED"}
    assert renewing._awaited == {blank.context.scene.session_uid: True}


def test_revert_is_checked_again(blank, actor, renewing):
    blank.ops.mocap_assist.denoise(plant_feet=False)
    blank.ops.mocap_assist.measure_quality()
    renewing.timers.clear()

    blank.ops.mocap_assist.revert_to_raw()

    assert renewing.timers == [renewing.check_again]


class ShownList(NamedTuple):
    action: str
    issues: tuple


def state_of_list(bpy):
    shown = bpy.context.scene.mocap_assist
    action = shown.checked_action
    issues = tuple((each.name, each.kind, each.start) for each in shown.issues)
    return ShownList("" if action is None else action.name, issues)
