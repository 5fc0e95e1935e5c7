"""A newcomer's first minute in a Blender with a window: the sample, Fix My Take, the card.

    make test-gui DRIVERS=fix

Runs inside that Blender; `bgui` comes with the tool and moves a real pointer.
"""

import bgui
import bpy
from driver_scene import empty_scene, settle, until_done

AWAY = (500, 500)
LANGUAGES = {"ja_JP": "クリーン", "de_DE": "Bereinigen"}
"""Wide characters and long words: by language the word for Clean."""
FIRST_STEPS = ("mocap_assist.import_recording", "mocap_assist.load_sample", "wm.url_open")


def press(text, columns=(0.5,)):
    yield from bgui.scan(columns=columns)
    yield from bgui.click(*bgui.at(text))


def job():
    return bpy.context.window_manager.mocap_assist_job


def empty_state():
    """Only Import, the sample and the manual are there."""
    yield from settle(pointer=AWAY)
    bgui.shot("1-empty.png")
    yield from bgui.scan()
    for button in FIRST_STEPS:
        bgui.at(button)


def load_sample():
    yield from press("mocap_assist.load_sample")
    yield from settle(pointer=AWAY)
    armature = bpy.context.view_layer.objects.active
    assert armature.name == "Sample Walk" and armature.mode == "POSE"
    bgui.shot("2-sample.png")
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo()
    yield 0.5
    assert "Sample Walk" not in bpy.data.objects and not bpy.data.actions
    with bgui.override("WINDOW"):
        bpy.ops.ed.redo()
    yield 0.5
    armature = bpy.context.view_layer.objects.active
    assert armature.name == "Sample Walk" and armature.animation_data.action
    return armature


def escape_leaves_the_scene_as_it_was(armature):
    raw = armature.animation_data.action
    yield from press("mocap_assist.fix_take")
    yield 1.0
    assert job().running and job().owner == "fix"
    yield from bgui.key("Escape")
    yield 0.5
    assert not job().running and armature.animation_data.action == raw


def fix(armature):
    yield from press("mocap_assist.fix_take")
    bgui.move(*AWAY)
    while job().fraction < 0.2:
        assert job().running
        yield 0.1
    bgui.shot("3-running.png")
    yield from until_done()
    yield from settle(pointer=AWAY)
    assert armature.animation_data.action.name == "Sample Walk.clean"
    bgui.shot("4-card.png")


def details():
    yield from press("mocap_assist_fix_details")
    assert bpy.context.window_manager.mocap_assist_fix_details
    yield from settle(pointer=AWAY)
    bgui.shot("5-details.png")
    yield from press("mocap_assist_fix_details")


def undo_is_one_step(armature):
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo()
    yield 0.5
    armature = bpy.context.view_layer.objects.active
    assert armature.animation_data.action.name == "Sample Walk", armature.animation_data.action
    with bgui.override("WINDOW"):
        bpy.ops.ed.redo()
    yield 0.5
    armature = bpy.context.view_layer.objects.active
    assert armature.animation_data.action.name == "Sample Walk.clean"
    return armature


def revert(armature):
    yield from press("mocap_assist.revert_to_raw", columns=(0.2, 0.5, 0.8))
    yield from settle(pointer=AWAY)
    assert armature.animation_data.action.name == "Sample Walk"
    bgui.shot("6-reverted.png")


def accept(armature):
    yield from press("mocap_assist.fix_take")
    yield from until_done()
    yield from press("mocap_assist.accept_fix", columns=(0.2, 0.5, 0.8))
    yield from settle(pointer=AWAY)
    assert armature.animation_data.action.name.startswith("Sample Walk.clean")
    assert "mocap_assist_fix" not in armature.animation_data.action
    bgui.shot("7-accepted.png")


def other_languages():
    """Picture the card where this Blender has its own languages; look for cut words."""
    view = bpy.context.preferences.view
    for language, clean in LANGUAGES.items():
        try:
            view.language = language
        except TypeError:  # Some builds have English alone.
            return
        translate = bpy.app.translations.pgettext_iface
        assert translate("Clean", "Mocap Assist") == clean
        yield from settle(pointer=AWAY)
        bgui.shot(f"11-{language}.png")
    view.language = "en_US"


def fix_several(armature):
    """Two takes, a pause between them, and the list with their status."""
    with bgui.override("WINDOW"):
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.mocap_assist.load_sample()
    second = bpy.context.view_layer.objects.active
    with bgui.override("WINDOW"):
        bpy.ops.object.mode_set(mode="OBJECT")
    armature.select_set(True)
    second.select_set(True)
    yield from settle(pointer=AWAY)
    bgui.shot("8-several.png")
    yield from press("mocap_assist.fix_takes")
    queue = bpy.context.window_manager.mocap_assist_queue
    queue.paused = True  # the takes are too short to find the button meanwhile
    while job().message != "Paused":
        yield 0.2
    assert [each.status for each in queue.takes] == ["DONE", "WAITING"]
    yield from settle(pointer=AWAY)
    bgui.shot("9-paused.png")
    yield from press("paused")
    yield 0.3
    assert not queue.paused and job().running
    yield from bgui.click(*bgui.at("paused"))
    yield 0.3
    assert queue.paused and job().running  # the sidebar takes clicks during the work
    yield from until_done()
    assert [each.status for each in queue.takes] == ["DONE", "DONE"]
    yield from settle(pointer=AWAY)
    bgui.shot("10-several-done.png")


def undo_takes_back_one_take():
    names = {each.animation_data.action.name for each in bpy.data.objects}
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo()
    yield 0.5
    left = {each.animation_data.action.name for each in bpy.data.objects}
    assert len(names - left) == 1, (names, left)


def steps():
    empty_scene()
    yield from bgui.open_sidebar("Mocap")
    yield from empty_state()
    armature = yield from load_sample()
    yield from escape_leaves_the_scene_as_it_was(armature)
    yield from fix(armature)
    yield from details()
    armature = yield from undo_is_one_step(armature)
    yield from revert(armature)
    yield from accept(armature)
    yield from fix_several(armature)
    yield from undo_takes_back_one_take()
    yield from other_languages()


bgui.run(steps, timeout=1500)
