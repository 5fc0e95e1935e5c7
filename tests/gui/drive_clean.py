"""Use the extension as an animator does, in a Blender with a window, and take pictures.

    make test-gui DRIVERS=clean

Runs inside that Blender; `bgui` comes with the tool and moves a real pointer. Not a test of
pytest's: pictures are for eyes. What can be asserted is.
"""

import json
import webbrowser
from pathlib import Path
from urllib.parse import unquote, urlparse

import bgui
import bpy
from driver_scene import (
    WHEEL_DOWN,
    WHEEL_UP,
    empty_scene,
    import_noisy_walk,
    look_at_figure,
    lose_arm,
    open_preferences,
    scroll,
    settle,
)

AWAY = (500, 500)
ROW = 23  # pixels from one row of a panel to the next
EDITORS = {"FCURVES": "GRAPH_EDITOR", "DOPESHEET": "DOPESHEET_EDITOR"}
UNTIL_DONE = 600  # half seconds


def set_the_stage():
    """Leave only the armature in the scene, in front view, in Pose Mode."""
    empty_scene()
    armature = import_noisy_walk()
    lose_arm(armature)
    armature.data.display_type = "STICK"
    bpy.context.scene.frame_set(150)
    with bgui.override("WINDOW"):
        bpy.ops.object.mode_set(mode="POSE")
    return armature


def job():
    return bpy.context.window_manager.mocap_assist_job


def wait_until_done():
    for _ in range(UNTIL_DONE):
        yield 0.5
        if not job().running:
            return
    raise TimeoutError("the solve did not end")


def press(button):
    """Press a button of the tab, at the end of it if it is not in view."""
    yield from bgui.scan()
    if not any(button in what for *_, what in bgui.found):
        yield from scroll(WHEEL_DOWN)
        yield from bgui.scan()
    yield from bgui.click(*bgui.at(button))


def names():
    return sorted(action.name for action in bpy.data.actions)


def cancel_leaves_the_scene_as_it_was(armature):
    raw, before = armature.animation_data.action, names()
    yield from press("mocap_assist.denoise")
    while not job().running:
        yield 0.05
    yield from bgui.key("Escape")
    yield 0.5
    assert not job().running
    assert names() == before
    assert armature.animation_data.action == raw
    bgui.shot("2-escaped.png")


def clean(armature):
    raw = armature.animation_data.action
    yield from press("mocap_assist.denoise")
    bgui.move(500, 500)
    while job().fraction < 0.3:
        assert job().running
        yield 0.2
    yield 0.8
    bgui.shot("3-running.png")
    yield from wait_until_done()
    assert armature.animation_data.action.name == f"{raw.name}.clean"
    yield from settle(pointer=AWAY)
    bgui.shot("4-cleaned.png")


def the_redo_panel(armature):
    """F9 offers what needs no new solve; a change there is applied to the same recording."""
    bgui.move(500, 500)
    yield 0.3
    with bgui.override("WINDOW"):  # the function keys do not reach Blender here
        bpy.ops.screen.redo_last("INVOKE_DEFAULT")
    yield 1.5
    bgui.shot("11-redo.png")
    yield from bgui.dismiss()
    with bgui.override("WINDOW"):
        assert bpy.context.window_manager.operators[-1].bl_idname == "MOCAP_ASSIST_OT_denoise"


def the_manual():
    """F1 over a button opens its chapter of the page that came with the extension."""
    opened, really = [], webbrowser.open
    webbrowser.open = lambda address, *_, **__: opened.append(address) or True
    try:
        yield from bgui.scan()
        yield from bgui.hover(*bgui.at("mocap_assist.denoise"))
        bgui.shot("12-tooltip.png")
        with bgui.override():
            bpy.ops.wm.doc_view_manual_ui_context()
        yield 1.0
    finally:
        webbrowser.open = really
    page, _, chapter = opened[-1].partition("#")
    assert chapter == "clean", opened
    assert Path(unquote(urlparse(page).path)).is_file(), opened


def other_editors():
    """The same tab in the Graph Editor and in the Dope Sheet."""
    view = bgui.area()
    for number, (editor, kind) in enumerate(EDITORS.items(), start=13):
        view.ui_type = editor
        yield 0.5
        view.spaces.active.show_region_ui = True
        sidebar = next(each for each in view.regions if each.type == "UI")
        for _ in range(40):
            bgui.redraw()
            yield 0.1
            try:
                sidebar.active_panel_category = "Mocap"
                break
            except TypeError:  # the tabs exist once they have been drawn
                continue
        assert view.type == kind and sidebar.active_panel_category == "Mocap"
        yield from settle(pointer=AWAY)
        bgui.shot(f"{number}-{editor.lower()}.png")
    view.ui_type = "VIEW_3D"
    yield 0.5


def clean_again_with_other_settings(armature):
    """The second press takes what the sidebar says now, not what the first one took."""
    settings = bpy.context.scene.mocap_assist.clean
    settings.strength, settings.plant_feet = 0.5, False
    yield from press("mocap_assist.denoise")
    yield 1.0
    yield from wait_until_done()
    history = json.loads(armature.animation_data.action["mocap_assist_history"])
    assert history[-1]["settings"]["strength"] == 0.5
    assert not history[-1]["settings"]["plant_feet"]
    settings.strength, settings.plant_feet = 1.0, True


def presets_and_body_parts():
    """The presets of the panel, and the strengths with their dots for keys."""
    clean = bpy.context.scene.mocap_assist.clean
    yield from bgui.scan()
    column, row = bgui.at("mocap_assist.denoise")
    bgui.move(column, row)
    with bgui.override("WINDOW"):
        bpy.ops.wm.call_panel(name="MOCAP_PT_clean_presets", keep_open=True)
    yield 1.0
    bgui.shot("15-presets.png")
    yield from bgui.dismiss()
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.use_preset(group="clean", preset="Light")
    assert clean.strength == 0.5 and not clean.hold_rotation
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.use_preset(group="clean", preset="Normal")
    yield from bgui.scan()
    column, row = bgui.at("clean.plant_feet")
    yield from bgui.click(column, row - ROW)
    yield from settle(pointer=AWAY)
    bgui.shot("16-body-parts.png")
    yield from bgui.click(column, row - ROW)


def delta_layer(armature):
    """The change above the recording, and its influence in the panel Compare."""
    bpy.context.scene.mocap_assist.issues.clear()  # or its list would be scrolled
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.denoise(result_as="DELTA_LAYER")
    strip = armature.animation_data.nla_tracks[-1].strips[0]
    assert strip.blend_type == "COMBINE" and strip.influence == 1.0
    yield from scroll(WHEEL_DOWN)
    yield from bgui.scan()
    assert bgui.at(".influence")
    strip.influence = 0.5
    yield from settle(pointer=AWAY)
    bgui.shot("17-delta.png")
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.revert_to_raw()
    assert not armature.animation_data.nla_tracks


def revert_and_compare(armature):
    """Back to the recorded action; the overlay still shows both."""
    yield from scroll(WHEEL_DOWN)
    yield from press("mocap_assist_overlay")
    yield from settle(pointer=AWAY)
    bgui.shot("5-overlay.png")
    yield from scroll(WHEEL_DOWN)
    yield from settle(pointer=AWAY)
    yield from press("mocap_assist.revert_to_raw")
    assert armature.animation_data.action.name == "walk"
    yield from settle(pointer=AWAY)
    yield from bgui.scan()
    yield from bgui.hover(*bgui.at("mocap_assist.revert_to_raw"))
    bgui.shot("6-greyed.png")


def check():
    found = bpy.context.scene.mocap_assist
    yield from scroll(WHEEL_UP)
    yield from press("mocap_assist.measure_quality")
    yield from wait_until_done()
    assert found.issues
    yield from settle(pointer=AWAY)
    yield from bgui.scan(columns=(0.25, 0.75))
    yield from bgui.click(*bgui.at("mocap_assist.jump_to_issue(index=2)"))
    issue = found.issues[2]
    assert found.active_issue == 2
    assert bpy.context.scene.frame_current == int(issue.start)
    assert bpy.context.active_pose_bone.name == issue.name
    yield from bgui.click(*bgui.at("mocap_assist.jump_to_issue(step=1)"))
    yield from settle(pointer=AWAY)
    assert found.active_issue == 3
    look_at_figure()
    yield from settle(pointer=AWAY)
    bgui.shot("7-issues.png")


def wide_sidebar_with_examples():
    """Drag the sidebar's edge, learn from examples, and unfold what is folded."""
    bpy.data.actions.new("run in place")
    clean = bpy.context.scene.mocap_assist.clean
    clean.prior, clean.examples = "EXAMPLES", "walk.clean; /captures/day 1/stroll.bvh"
    sidebar = bgui.region()
    edge, middle = sidebar.x + 1, sidebar.y + 40
    bgui.move(edge, middle)
    yield 0.2
    bgui.x("mousedown", 1)
    for step in range(0, 130, 10):
        bgui.move(edge - step, middle)
        yield 0.05
    bgui.x("mouseup", 1)
    yield from settle(pointer=AWAY)
    yield from bgui.scan()
    bgui.shot("8-wide.png")
    # The pointer cannot ask a menu for its name: it is one row above the file.
    column, row = bgui.at("learned_file")
    yield from bgui.click(column, row + ROW)
    yield 0.5
    bgui.shot("9-examples.png")
    yield from bgui.dismiss()


def steps():
    armature = set_the_stage()
    look_at_figure()
    yield 0.5
    bgui.area().spaces.active.show_region_ui = True
    yield from bgui.open_sidebar("Mocap")
    bgui.shot("1-panels.png")
    yield from cancel_leaves_the_scene_as_it_was(armature)
    yield from clean(armature)
    yield from the_redo_panel(armature)
    yield from the_manual()
    yield from presets_and_body_parts()
    yield from revert_and_compare(armature)
    yield from check()
    yield from clean_again_with_other_settings(armature)
    yield from other_editors()
    yield from bgui.open_sidebar("Mocap")
    yield from wide_sidebar_with_examples()
    yield from delta_layer(armature)
    yield from open_preferences()
    bgui.shot("10-preferences.png")


bgui.run(steps, timeout=1500)
