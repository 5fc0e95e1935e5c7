"""A button that was pressed in a window waits for its solve; here Blender pretends to."""

import tempfile
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import pytest
from modal_events import event, wait

BUSY = "Another solve is running"


def folders():
    return set(Path(tempfile.gettempdir()).glob("mocap_assist_*"))


@pytest.fixture
def press_clean(make_button, window, load):
    """Press Clean, without feet; return the button, which has read the take and waits."""
    button_settings = load("mocap_assist.clean.button_settings")
    denoising = load("solvers.denoising")

    def press(**chosen):
        settings = button_settings.CleanBundle(
            button_settings.CleanChoices(plant_feet=False, **chosen),
            denoising.DenoiseSettings(),
            denoising.PlantSettings(),
        )
        button = make_button("denoise", settings)
        assert button.invoke(window.context, None) == {"RUNNING_MODAL"}
        assert wait(button, window, until=lambda: button._is_solving) is None
        return button

    return press


@pytest.mark.parametrize("key", ["ESC", "RIGHTMOUSE"])
def test_escape_cancels_the_solve_and_writes_nothing(noisy, press_clean, window, blank, key):
    actions = blank.data.actions.keys()

    button = press_clean()

    assert window.status[-1].endswith("%   Esc cancels [mocap_assist.cancel_solve]")
    assert window.job.owner == "clean"
    for other in (event("TIMER"), event("LEFTMOUSE", "PRESS")):
        assert button.modal(window.context, other) == {"RUNNING_MODAL"}
    assert button.modal(window.context, event(key, "PRESS")) == {"CANCELLED"}
    assert blank.data.actions.keys() == actions
    assert window.timers == [] and window.status[-1] is None
    assert not window.job.running and folders() == set()
    assert window.reports == [({"INFO"}, "Cancelled.")]


def test_cancel_button_ends_the_solve(noisy, press_clean, window, blank):
    button = press_clean()

    assert blank.ops.mocap_assist.cancel_solve() == {"FINISHED"}
    assert wait(button, window) == {"CANCELLED"}
    assert window.timers == [] and folders() == set()
    assert window.reports == [({"INFO"}, "Cancelled.")]


def test_view_can_be_moved_only_while_another_process_solves(noisy, make_button, window):
    orbit = event("MIDDLEMOUSE", "PRESS")
    button = make_button("denoise", None)
    button._watch = SimpleNamespace(is_on=True, is_cancelled=False)

    answers = []
    for button._is_solving in (False, True):
        answers.append(button.modal(window.context, orbit))

    assert answers == [{"RUNNING_MODAL"}, {"PASS_THROUGH"}]


class TooLarge:
    """A solve for which there is too little memory."""

    def __reduce__(self):
        return eval, ("lambda take, progress: b'.' * (1 << 62)",)

    def __call__(self, *_, **__):
        raise AssertionError("It was called in this process.")


def test_out_of_memory_is_one_sentence_in_a_window_and_in_a_script(
    noisy, make_button, window, load
):
    button = make_button("denoise", None)
    type(button).read_scene = staticmethod(lambda *_: partial(TooLarge(), None))
    button.invoke(window.context, None)

    assert wait(button, window) == {"CANCELLED"}
    assert button.execute(window.context) == {"CANCELLED"}

    sentence = "This needs more memory than is available. Work on a part of the take."
    assert window.reports == [({"ERROR"}, sentence)] * 2
    assert folders() == set()


def test_result_is_written_to_the_armature_that_was_read(
    noisy, make_armature, animate, press_clean, window, blank
):
    button = press_clean()
    other = make_armature(name="Other")  # it is active now, as a second window would have it
    untouched = animate(other)
    scene = window.context.scene
    window.context.scene = blank.data.scenes.new("another")

    assert wait(button, window) == {"FINISHED"}

    assert noisy.animation_data.action.name == "walk.clean"
    assert other.animation_data.action == untouched
    assert blank.context.scene == scene and window.reports[-1][1].startswith("walk.clean")
    assert window.timers == [] and window.status[-1] is None and not window.job.running


def test_redo_adjusts_the_armature_that_was_read(
    noisy, make_armature, animate, press_clean, window
):
    button = press_clean()
    other = make_armature(name="Other")
    untouched = animate(other)
    wait(button, window)

    assert button.execute(window.context) == {"FINISHED"}

    assert noisy.animation_data.action.name == "walk.clean.001"
    assert other.animation_data.action == untouched


def test_bones_selected_during_the_solve_are_not_written(
    noisy, press_clean, window, load, keys_of
):
    compat, bones = (
        load("mocap_assist.blender.compat"),
        load("mocap_assist.clean.button_settings").Bones,
    )
    before = keys_of(noisy.animation_data.action)
    for bone in noisy.pose.bones:
        compat.select_bone(bone, bone.name == "Head")
    button = press_clean(bones=bones.SELECTED)
    for bone in noisy.pose.bones:
        compat.select_bone(bone, bone.name == "Spine")

    assert wait(button, window) == {"FINISHED"}

    after = keys_of(noisy.animation_data.action)
    changed = {path for slot, path, index in after
               if after[slot, path, index] != before[slot, path, index]}  # fmt: skip
    assert changed == {'pose.bones["Head"].rotation_euler'}


def move_a_key(bpy, armature):
    curve = armature.animation_data.action.layers[0].strips[0].channelbags[0].fcurves[0]
    curve.keyframe_points[10].co.y += 0.1


def play_another(bpy, armature):
    action = armature.animation_data.action.copy()
    armature.animation_data.action = action
    move_a_key(bpy, armature)


def rotate_the_rig(bpy, armature):
    armature.rotation_euler.z += 1.0


@pytest.mark.parametrize("change", [move_a_key, play_another, rotate_the_rig])
def test_changes_during_the_solve_are_not_overwritten(
    noisy, press_clean, window, blank, change
):
    button = press_clean()
    change(blank, noisy)
    action, actions = noisy.animation_data.action, blank.data.actions.keys()

    assert wait(button, window) == {"CANCELLED"}

    assert noisy.animation_data.action == action and blank.data.actions.keys() == actions
    kind, message = window.reports[-1]
    assert kind == {"ERROR"} and "Actor was changed during the solve; nothing was" in message


def test_armature_deleted_during_the_solve_is_reported(noisy, press_clean, window, blank):
    button = press_clean()
    blank.data.objects.remove(noisy)

    assert wait(button, window) == {"CANCELLED"}

    assert "Actor was deleted during the solve" in window.reports[-1][1]


def test_second_solve_is_refused_during_a_solve(noisy, press_clean, window, blank):
    button = press_clean()

    for name in ("denoise", "measure_quality", "plant_feet", "learn_patterns"):
        assert not getattr(blank.ops.mocap_assist, name).poll()
    with pytest.raises(RuntimeError, match=BUSY):
        blank.ops.mocap_assist.measure_quality()

    button.modal(window.context, event("ESC", "PRESS"))
    assert blank.ops.mocap_assist.measure_quality.poll()


def test_closing_its_window_ends_the_solve(noisy, press_clean, window, blank):
    button = press_clean()

    button.cancel(window.context)
    button.cancel(window.context)

    assert folders() == set() and window.timers == [] and not window.job.running
    assert blank.ops.mocap_assist.denoise.poll()


@pytest.fixture
def real_manager(window, blank, load, monkeypatch):
    """Let what ends by itself, without the button's context, find the pretended window."""
    found = SimpleNamespace(**vars(load("mocap_assist.runtime.file_change_handlers").bpy))
    found.context = window.context
    monkeypatch.setattr(load("mocap_assist.runtime.file_change_handlers"), "bpy", found)


def test_opening_another_file_ends_the_solve(noisy, press_clean, window, blank, real_manager):
    button = press_clean()

    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)

    assert folders() == set() and window.timers == []
    assert not blank.context.window_manager.mocap_assist_job.running
    assert button.modal(window.context, event("TIMER")) == {"CANCELLED"}


def test_disabling_the_extension_ends_the_solve(
    noisy, press_clean, window, extension, blank, real_manager
):
    press_clean()

    extension.unregister()
    extension.register()

    assert folders() == set() and window.timers == []
    assert not blank.context.window_manager.mocap_assist_job.running
    assert blank.ops.mocap_assist.denoise.poll()


def test_file_saved_during_a_solve_opens_without_a_running_solve(blank, load):
    blank.context.window_manager.mocap_assist_job.running = True

    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)

    assert not blank.context.window_manager.mocap_assist_job.running
