"""Import from a window: files are read in a process of its own; here Blender pretends to."""

import numpy as np
import pytest
from modal_events import event, nothing_is_left, wait


@pytest.fixture
def everything(blank):
    """What an import that comes to nothing must leave as it was."""

    def scene_state():
        view, scene = blank.context.view_layer, blank.context.scene
        kinds = (blank.data.objects, blank.data.armatures, blank.data.actions)
        active = view.objects.active
        return (
            *(sorted(each.name for each in kind) for kind in kinds),
            sorted(each.name for each in view.objects.selected),
            active and (active.name, active.mode),
            (scene.render.fps, scene.render.fps_base),
            (scene.frame_start, scene.frame_end, scene.frame_current),
        )

    return scene_state


@pytest.fixture
def posing(blank, bring, walks):
    """An animator poses one armature; another is selected too."""
    other, active = bring(walks / "second.bvh"), bring(walks / "first.bvh")
    other.select_set(True)
    blank.context.view_layer.objects.active = active
    blank.ops.object.mode_set(mode="POSE")
    return active


@pytest.mark.parametrize("key", ["ESC", "RIGHTMOUSE"])
def test_escape_while_files_are_read_leaves_all_as_it_was(
    posing, press, window, everything, key
):
    before = everything()
    operator = press("first.bvh", "second.bvh")

    assert window.job.running and window.status[-1].startswith("Starting 0%   Esc cancels")
    assert window.job.owner == "import"
    assert operator.modal(window.context, event("LEFTMOUSE", "PRESS")) == {"RUNNING_MODAL"}
    assert operator.modal(window.context, event(key, "PRESS")) == {"CANCELLED"}

    assert everything() == before
    assert nothing_is_left(window)
    assert window.reports == [({"INFO"}, "Cancelled.")]


def test_escape_after_the_first_has_come_in_takes_it_back(
    posing, press, window, everything, load, blank
):
    blank.context.scene.render.fps, blank.context.scene.frame_end = 24, 40
    before = everything()
    update = load("mocap_assist.scene.scene_rate").FrameRate.UPDATE
    operator = press("first.bvh", "second.bvh", frame_rate=update, update_scene_duration=True)

    wait(operator, window, until=lambda: len(blank.data.objects) > len(before[0]))
    assert everything()[-2:] != before[-2:]
    assert window.status[-1].startswith("Importing second.bvh")
    assert operator.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}

    assert everything() == before
    assert nothing_is_left(window)


def test_escape_restores_rate_and_range_of_a_scene_without_animation(
    press, window, everything, blank
):
    scene = blank.context.scene
    scene.frame_start, scene.frame_end, scene.frame_current = 5, 900, 700
    before = everything()
    operator = press("first.bvh", "second.bvh")

    wait(operator, window, until=lambda: len(blank.data.objects) > 0)
    assert (scene.render.fps, scene.frame_end, scene.frame_current) == (120, 317, 1)
    operator.modal(window.context, event("ESC", "PRESS"))

    assert everything() == before


@pytest.mark.parametrize("bytes_at_once", [1, 64_000_000])
def test_all_that_can_be_read_comes_in(press, window, load, monkeypatch, blank, bytes_at_once):
    monkeypatch.setattr(
        load("mocap_assist.importing.dialog.job"), "BYTES_AT_ONCE", bytes_at_once
    )
    job = load("mocap_assist.jobs.job").Job
    done = job.done
    # The files are read in less time than may pass between two looks.
    monkeypatch.setattr(job, "done", lambda self: reading_is_shown(window) and done(self))
    operator = press("first.bvh", "cut.bvh", "second.bvh")

    assert wait(operator, window) == {"FINISHED"}

    assert sorted(blank.data.objects.keys()) == ["first", "second"]
    assert sorted(each.name for each in blank.context.view_layer.objects.selected) == [
        "first",
        "second",
    ]
    ((kind, message),) = window.reports
    assert kind == {"ERROR"}
    assert message.startswith("1 of 3 files failed.") and "cut.bvh" in message
    assert operator.note.startswith("first: an armature of 31 bones, 317 frames at 120 Hz.")
    assert nothing_is_left(window)
    percentages = [float(text.split("%")[0].split()[-1]) for text in window.status if text]
    assert percentages == sorted(percentages)
    assert reading_is_shown(window)


def reading_is_shown(window):
    return any(text and text.startswith("Reading ") for text in window.status)


@pytest.mark.parametrize("joints", [False, True])
@pytest.mark.parametrize("chosen", [{}, {"frame_rate": "RESAMPLE", "global_scale": 2.0}])
def test_it_is_what_a_script_gets(
    chosen, joints, press, window, bring, walks, blank, poses, load, recordings
):
    if joints:
        take = recordings / "kinect" / "irds" / "215_18_5_8_1_stand.txt"
        (walks / "first.bvh").write_bytes(take.read_bytes())
    expected = poses(bring(walks / "first.bvh", **chosen), [1, 30])
    blank.data.objects.remove(blank.context.object)
    if chosen:
        rates = load("mocap_assist.scene.scene_rate").FrameRate
        chosen = chosen | {"frame_rate": rates[chosen["frame_rate"]]}

    wait(press("first.bvh", **chosen), window)

    found = poses(blank.context.view_layer.objects.active, [1, 30])
    assert found.keys() == expected.keys()
    for name, matrices in expected.items():
        np.testing.assert_array_equal(found[name], matrices)


def test_the_redo_panel_need_not_read_again(press, window, load, walks, monkeypatch, blank):
    operator = press("first.bvh")
    wait(operator, window)

    def fail(*_, **__):
        raise AssertionError("It was read again.")

    monkeypatch.setattr(load("mocap_assist.importing.recent_files"), "read_takes", fail)
    operator.execute(blank.context)

    assert len(blank.data.objects) == 2


def test_closing_the_window_ends_it(posing, press, window, everything):
    before = everything()
    operator = press("first.bvh")

    operator.cancel(window.context)
    operator.cancel(window.context)

    assert everything() == before
    assert nothing_is_left(window)


def test_what_goes_wrong_unforeseen_leaves_no_watch(
    press, window, everything, load, monkeypatch
):
    before = everything()

    def fail(*_, **__):
        raise ZeroDivisionError

    monkeypatch.setattr(
        load("mocap_assist.importing.transaction").ImportTransaction, "add", fail
    )
    operator = press("first.bvh")
    with pytest.raises(ZeroDivisionError):
        wait(operator, window)

    assert everything() == before
    assert nothing_is_left(window)


def test_a_fault_over_the_only_file_is_a_sentence_and_leaves_nothing(
    press, window, everything, load, monkeypatch
):
    before = everything()

    def fail(*_, **__):
        raise ZeroDivisionError

    monkeypatch.setattr(load("mocap_assist.importing.transaction"), "make_objects", fail)

    assert wait(press("first.bvh"), window) == {"CANCELLED"}

    assert everything() == before
    assert nothing_is_left(window)
    ((kind, message),) = window.reports
    assert kind == {"ERROR"}
    assert "first.bvh: this is a bug in Mocap Assist (ZeroDivisionError at" in message


def test_one_at_a_time(press, window, blank):
    operator = press("first.bvh")

    assert not blank.ops.mocap_assist.import_recording.poll()
    operator.modal(window.context, event("ESC", "PRESS"))
    assert blank.ops.mocap_assist.import_recording.poll()


@pytest.mark.parametrize("fault", ["cut", "half way"])
def test_a_script_too_keeps_pose_mode_and_selection_where_all_fails(
    posing, everything, walks, blank, load, monkeypatch, fault
):
    before = everything()
    if fault == "half way":
        errors = load("solvers.errors")

        def fail(*_, **__):
            raise errors.InvalidMotionError("Half way.")

        monkeypatch.setattr(
            load("mocap_assist.importing.recording_objects"), "write_motion", fail
        )
    name = "cut.bvh" if fault == "cut" else "first.bvh"

    with pytest.raises(RuntimeError, match=name):
        blank.ops.mocap_assist.import_recording(filepath=str(walks / name))

    assert everything() == before


def test_the_dialog_does_not_wait_for_a_large_file(load, walks, monkeypatch, blank):
    importing = load("mocap_assist.importing.importing")
    small = importing.preview(blank.context, [walks / "first.bvh"])
    monkeypatch.setattr(importing, "MAX_PREVIEW_BYTES", 1000)
    monkeypatch.setattr(importing, "read_again", None)
    blank.context.scene.render.fps = 24

    large = importing.preview(blank.context, [walks / "first.bvh"])

    assert small.startswith("first.bvh: 317 frames at 120 Hz; the scene plays at 24 FPS. Y is")
    assert small.endswith("lengths are in units of 0.05644 m.")
    assert large == "first.bvh: 0.2 MB; the scene plays at 24 FPS."
    assert "cannot be read" in importing.preview(blank.context, [walks / "gone.bvh"])
