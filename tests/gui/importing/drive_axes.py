"""Import a walk and joints in their dialogs, change the up axis, and take pictures.

    make test-gui DRIVERS=axes

Runs inside a Blender with a window; `bgui` comes with the tool and moves a real pointer.
"""

from pathlib import Path

import bgui
import bpy
from driver_scene import empty_scene, settle, until_done

FOLDER = Path(__file__).parent
WALK, JOINTS = FOLDER / "walk.bvh", FOLDER / "joints.txt"
CHANGE = "mocap_assist.change_axes"
SCALE, CONFIRM = (1070, 651), (1091, 620)
"""Positions of a field and a button of the dialog, which opens below the pointer."""


def drop(path):
    """Open the dialog that Blender shows where a file is dropped."""
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            "INVOKE_DEFAULT", directory=str(FOLDER), files=[{"name": path.name}]
        )


def head_above_hips(armature):
    """Meters; a take with another axis up also travels along it, so the hips are no floor."""
    bones = {bone.name.lower(): bone for bone in armature.pose.bones}
    heights = [(armature.matrix_world @ bones[each].head).z for each in ("head", "hips")]
    return heights[0] - heights[1]


def show_joints_dialog():
    """Open the dialog for joints of a camera, and close it."""
    bgui.move(500, 500)
    drop(JOINTS)
    yield 1.5
    bgui.shot("1-joints-dialog.png")
    yield from bgui.key("Escape")
    yield 0.5


def double_the_size():
    """Type another scale into the dialog, which is below the pointer, and confirm it."""
    yield from bgui.click(*SCALE)
    yield from bgui.click(*SCALE)
    yield from bgui.key("ctrl+a")
    yield from bgui.type_text("2")
    yield from bgui.key("Return")
    yield from bgui.click(*CONFIRM)


def steps():
    empty_scene()
    yield from bgui.open_sidebar("Mocap")
    yield from show_joints_dialog()
    drop(WALK)
    yield 1.5
    bgui.shot("2-walk-dialog.png")
    yield from bgui.key("Return")
    yield 0.5
    yield from until_done()
    armature = bpy.context.object
    assert armature is not None and armature.type == "ARMATURE", armature
    bpy.context.scene.frame_set(20)
    tall = head_above_hips(armature)
    assert tall > 0.4, tall
    yield from settle()
    bgui.shot("3-imported.png")
    yield from bgui.scan()
    yield from bgui.click(*bgui.at(CHANGE))
    yield 1.5
    bgui.shot("4-change-dialog.png")
    yield from double_the_size()
    yield from settle()
    bgui.shot("4b-doubled.png")
    assert 1.9 < head_above_hips(armature) / tall < 2.1, head_above_hips(armature)
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.change_axes(up="Z", global_scale=1.0)
    yield from settle()
    lying = head_above_hips(armature)
    assert abs(lying) < 0.5 * tall, (lying, tall)
    bgui.shot("5-changed.png")


bgui.run(steps, timeout=1500)
