"""Results are checked again, quietly, in a scene where Check was pressed before."""

from contextlib import nullcontext
from types import SimpleNamespace

import bpy
import pytest
from modal_events import event, nothing_is_left, wait


def test_results_are_checked_again_where_check_was_pressed_before(blank, actor, renewing):
    timers = renewing.timers
    blank.ops.mocap_assist.denoise()
    assert not timers

    blank.ops.mocap_assist.measure_quality()
    assert not timers  # a check makes no result
    blank.ops.mocap_assist.denoise(strength=0.5)

    assert timers == [renewing.check_again]


def test_results_are_checked_again_in_a_window_of_their_scene(blank, load, monkeypatch):
    renewing, pressed = load("mocap_assist.check.renewing"), []
    scenes = [SimpleNamespace(session_uid=number) for number in (1, 2)]
    view = SimpleNamespace(type="VIEW_3D", regions=[SimpleNamespace(type="WINDOW")])
    screen = SimpleNamespace(areas=[view])
    windows = [SimpleNamespace(scene=scene, screen=screen) for scene in scenes]
    context = SimpleNamespace(
        window_manager=SimpleNamespace(windows=windows),
        temp_override=lambda window, **_: nullcontext(pressed.append(window)),
    )
    check = SimpleNamespace(poll=lambda: False)
    ops = SimpleNamespace(mocap_assist=SimpleNamespace(measure_quality=check))
    monkeypatch.setattr(renewing, "bpy", SimpleNamespace(context=context, ops=ops))
    monkeypatch.setattr(renewing, "_awaited", {2: False})

    renewing.check_again()

    assert pressed == windows[1:]
    assert renewing._awaited == {2: False}  # nothing there can be checked yet


@pytest.fixture
def scene_is_shown(load, renewing, monkeypatch):
    """What Blender calls after a window shows another scene."""
    subscribed = []
    bus = SimpleNamespace(
        clear_by_owner=lambda _: None, subscribe_rna=lambda **given: subscribed.append(given)
    )
    with monkeypatch.context() as patch:
        patch.setattr(
            load("mocap_assist.blender.subscriptions"), "bpy", SimpleNamespace(msgbus=bus)
        )
        renewing._watch_scenes()
        renewing._ignore_scenes()
    (found,) = subscribed
    assert found["key"] == (bpy.types.Window, "scene")
    return found["notify"]


def test_result_is_checked_once_its_scene_is_shown_again(
    blank, actor, renewing, scene_is_shown, monkeypatch
):
    """The animator looked at another scene when the solve ended; the list stayed old."""
    ours = blank.context.scene
    blank.ops.mocap_assist.measure_quality()
    other, pressed = blank.data.scenes.new("Other"), []
    windows = [SimpleNamespace(scene=other)]
    renewing.renew_later(ours)
    other.mocap_assist.report = "Check was pressed there, too."
    renewing.renew_later(other)
    renewing._awaited.pop(other.session_uid)
    renewing.timers.clear()
    view = SimpleNamespace(type="VIEW_3D", regions=[SimpleNamespace(type="WINDOW")])
    context = SimpleNamespace(
        window_manager=SimpleNamespace(windows=windows),
        view_layer=blank.context.view_layer,
        temp_override=lambda **_: nullcontext(),
    )
    ops = SimpleNamespace(mocap_assist=SimpleNamespace(measure_quality=PressedCheck(pressed)))
    monkeypatch.setattr(renewing.bpy, "context", context)
    monkeypatch.setattr(renewing.bpy, "ops", ops, raising=False)
    blank.ops.mocap_assist.denoise(plant_feet=False)

    renewing.check_again()
    assert not pressed
    windows[0] = SimpleNamespace(scene=ours, screen=SimpleNamespace(areas=[view]))
    scene_is_shown()
    assert renewing.timers == [renewing.check_again]
    renewing.check_again()

    assert pressed == [{"is_quiet": True}]


def test_list_of_before_says_that_the_result_is_being_checked(blank, actor, draw, renewing):
    blank.ops.mocap_assist.measure_quality()
    blank.context.scene.mocap_assist.issues.add()

    blank.ops.mocap_assist.denoise(plant_feet=False)
    assert "which is being checked." in " ".join(draw("MOCAP_PT_check"))

    renewing.timers.clear()  # it was called, and the check has ended
    assert "Run Check again." in " ".join(draw("MOCAP_PT_check"))


def test_result_is_of_the_scene_in_which_its_button_was_pressed(
    blank, actor, load, check, window, monkeypatch
):
    notified, ours = [], blank.context.scene
    listeners = [lambda scene: notified.append(scene.name)]
    monkeypatch.setattr(load("mocap_assist.runtime.after_result"), "listeners", listeners)
    button = check(is_quiet=False)
    assert button.invoke(window.context, None) == {"RUNNING_MODAL"}

    blank.context.window.scene = blank.data.scenes.new("Other")
    assert wait(button, window) == {"FINISHED"}
    blank.context.window.scene = ours

    assert notified == [ours.name]


def test_a_list_of_what_is_played_is_not_renewed(blank, actor, load, monkeypatch):
    """A result of Fix brings its list along; a check would only lock all buttons."""
    renewing, pressed = load("mocap_assist.check.renewing"), []
    scene = blank.context.scene
    view = SimpleNamespace(type="VIEW_3D", regions=[SimpleNamespace(type="WINDOW")])
    window = SimpleNamespace(scene=scene, screen=SimpleNamespace(areas=[view]))
    context = SimpleNamespace(
        window_manager=SimpleNamespace(windows=[window]),
        view_layer=blank.context.view_layer,
        temp_override=lambda **_: nullcontext(),
    )
    check = PressedCheck(pressed)
    ops = SimpleNamespace(mocap_assist=SimpleNamespace(measure_quality=check))
    for press in (blank.ops.mocap_assist.measure_quality, blank.ops.mocap_assist.denoise):
        press()
        with monkeypatch.context() as patch:
            patch.setattr(renewing, "_awaited", {scene.session_uid: False})
            patch.setattr(renewing, "bpy", SimpleNamespace(context=context, ops=ops))
            renewing.check_again()

    assert pressed == [{"is_quiet": True}]  # after Clean


class PressedCheck:
    def __init__(self, pressed):
        self.pressed = pressed

    def poll(self):
        return True

    def __call__(self, mode, **settings):
        self.pressed.append(settings)


def test_only_a_check_that_was_asked_for_takes_the_window(actor, check, window):
    button = check(is_quiet=False)
    assert button.invoke(window.context, None) == {"RUNNING_MODAL"}
    assert button.modal(window.context, event("A", "PRESS")) == {"RUNNING_MODAL"}

    button.is_quiet = True
    for key in ("A", "ESC"):
        assert button.modal(window.context, event(key, "PRESS")) == {"PASS_THROUGH"}
    button.is_quiet = False
    assert button.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}


def test_quiet_check_makes_way_for_a_press(actor, blank, check, window):
    """Buttons were gray, and the message of the result was gone, until a check had ended."""
    quiet = check(is_quiet=True)
    assert quiet.invoke(window.context, None) == {"RUNNING_MODAL"}
    assert window.status == [] and not window.job.running
    assert blank.ops.mocap_assist.denoise.poll()

    pressed = check(is_quiet=False)
    assert pressed.invoke(window.context, None) == {"RUNNING_MODAL"}

    assert quiet.modal(window.context, event("TIMER")) == {"CANCELLED"}
    assert window.job.running and len(window.timers) == 1
    assert pressed.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}
    assert nothing_is_left(window)


def test_quiet_check_leaves_the_status_bar(blank, actor, capsys):
    assert blank.ops.mocap_assist.measure_quality(is_quiet=True) == {"FINISHED"}
    assert "ound" not in capsys.readouterr().out
    assert blank.context.scene.mocap_assist.checked_action

    blank.ops.mocap_assist.measure_quality()
    assert "ound" in capsys.readouterr().out


def test_check_that_a_press_ended_is_taken_up_after_that_solve(
    actor, blank, renewing, check, window
):
    """Its list stayed that of the recorded action."""
    blank.ops.mocap_assist.measure_quality()
    blank.ops.mocap_assist.denoise(plant_feet=False)
    renewing.timers.clear()  # Blender calls them once
    assert check(is_quiet=True).invoke(window.context, None) == {"RUNNING_MODAL"}
    pressed = check(is_quiet=False)
    assert pressed.invoke(window.context, None) == {"RUNNING_MODAL"}
    assert not renewing.timers

    assert pressed.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}

    assert renewing.timers == [renewing.check_again]


def test_no_check_reads_the_recorded_action_while_its_key_is_held(actor, blank, renewing, load):
    blank.ops.mocap_assist.measure_quality()
    blank.ops.mocap_assist.denoise(plant_feet=False)
    raw_view = load("mocap_assist.check.raw_view")
    raw_view.show_raw(blank.context)
    renewing.timers.clear()

    assert renewing.check_again() is None  # and it touches no window
    raw_view.restore_played()

    assert renewing.timers == [renewing.check_again]


def test_nothing_is_taken_up_after_a_check_has_ended(actor, blank, renewing, check, window):
    blank.ops.mocap_assist.measure_quality()
    blank.ops.mocap_assist.denoise(plant_feet=False)
    blank.ops.mocap_assist.measure_quality()
    renewing.timers.clear()
    pressed = check(is_quiet=False)
    pressed.invoke(window.context, None)

    pressed.modal(window.context, event("ESC", "PRESS"))

    assert not renewing.timers


def test_a_list_whose_action_was_deleted_is_renewed(actor, blank, renewing):
    blank.ops.mocap_assist.measure_quality()
    blank.context.scene.mocap_assist.checked_action = None

    blank.ops.mocap_assist.denoise(plant_feet=False)

    assert renewing.timers == [renewing.check_again]


def test_panels_keep_what_they_say_of_a_result_while_the_recorded_action_is_shown(
    blank, actor, draw, load
):
    """They said that nothing was checked, and were another size, while the key was held."""
    assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}
    assert blank.ops.mocap_assist.measure_quality() == {"FINISHED"}
    names = "MOCAP_PT_check", "MOCAP_PT_compare", "MOCAP_PT_fix"
    before = [draw(name) for name in names]
    raw_view = load("mocap_assist.check.raw_view")

    raw_view.show_raw(blank.context)
    assert actor.animation_data.action.name == "walk"
    assert [draw(name) for name in names] == before
    raw_view.restore_played()

    actor.animation_data.action = blank.data.actions["walk"]
    assert draw("MOCAP_PT_check") != before[0]
