"""Results are checked again, quietly, in a scene where Check was pressed before."""

from contextlib import nullcontext
from types import SimpleNamespace

from modal_events import event, nothing_is_left


def test_results_are_checked_again_where_check_was_pressed_before(blank, actor, renewing):
    timers = renewing.timers
    blank.ops.mocap_assist.denoise()
    assert not timers

    blank.ops.mocap_assist.measure_quality()
    assert not timers  # a check makes no result
    blank.ops.mocap_assist.denoise(strength=0.5)

    assert timers == [renewing.renew]


def test_results_are_checked_again_in_a_window_of_their_scene(blank, load, monkeypatch):
    renewing, pressed = load("mocap_assist.check.renewing"), []
    scenes = [SimpleNamespace(name=name) for name in ("Other", "Ours")]
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
    monkeypatch.setattr(renewing, "_awaited", {"Ours": False})

    renewing.renew()

    assert pressed == windows[1:]


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
            patch.setattr(renewing, "_awaited", {scene.name: False})
            patch.setattr(renewing, "bpy", SimpleNamespace(context=context, ops=ops))
            renewing.renew()

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

    assert renewing.timers == [renewing.renew]


def test_no_check_reads_the_recorded_action_while_its_key_is_held(actor, blank, renewing, load):
    blank.ops.mocap_assist.measure_quality()
    blank.ops.mocap_assist.denoise(plant_feet=False)
    raw_view = load("mocap_assist.check.raw_view")
    raw_view.show_raw(blank.context)
    renewing.timers.clear()

    assert renewing.renew() is None  # and it touches no window
    raw_view.restore()

    assert renewing.timers == [renewing.renew]


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

    assert renewing.timers == [renewing.renew]
