"""Import a walk, open its *Adjust Last Operation* panel, and type another scale.

A solver waits as long as the tab is shown, and another one after each press.

    make test-gui DRIVERS=redo

Runs inside a Blender with a window; `bgui` comes with the tool and moves a real pointer.
"""

import sys
from pathlib import Path

import bgui
import bpy
from driver_scene import empty_scene, settle, until_done

JOBS = "bl_ext.user_default.mocap_assist.mocap_assist.jobs"
FOLDER = Path(__file__).parent
REDO_PANEL, SCALE = (78, 112), (270, 210)
"""Pixels at which Blender draws the header and the number; a scan does not reach them."""


def head_height():
    armature = bpy.context.object
    bones = [bone for bone in armature.pose.bones if bone.name.lower() == "head"]
    return (armature.matrix_world @ bones[0].head).z


def until_ready():
    """Wait for a solver that waits, and return its process."""
    module = sys.modules[f"{JOBS}.waiting_child"]
    for _ in range(100):
        if module._waiting and module._waiting[0].is_waiting():
            return module._waiting[0].process.pid
        yield 0.1
    raise AssertionError("No solver waits.")


def type_twice_the_scale():
    """Write 2 into the field *Scale*."""
    yield from bgui.click(*REDO_PANEL)
    yield 1.5
    bgui.shot("1-redo.png")
    bgui.move(*SCALE)
    yield 0.3
    for _ in range(2):  # a double click edits the number
        bgui.x("click", 1)
    yield 0.5
    yield from bgui.key("ctrl+a")
    yield from bgui.key("2")


def steps():
    empty_scene()
    yield from bgui.open_sidebar("Mocap")
    first = yield from until_ready()
    bgui.move(500, 500)
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            "INVOKE_DEFAULT", directory=str(FOLDER), files=[{"name": "walk.bvh"}]
        )
    yield 1.5
    yield from bgui.key("Return")
    yield 0.5
    yield from until_done()
    yield from settle()
    second = yield from until_ready()
    assert second != first
    low = head_height()
    assert low > 1.0, low
    yield from type_twice_the_scale()
    yield from bgui.key("Return")
    yield 1.0
    yield from until_done()
    yield from settle()
    bgui.shot("2-twice-as-tall.png")
    armatures = [each.name for each in bpy.data.objects if each.type == "ARMATURE"]
    assert armatures == ["walk"], armatures
    assert len(bpy.data.actions) == 1, list(bpy.data.actions)
    assert abs(head_height() - 2.0 * low) < 1e-3, (head_height(), low)


bgui.run(steps, timeout=1500)
