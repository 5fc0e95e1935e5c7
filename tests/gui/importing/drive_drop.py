"""Drop recordings on the 3D View of a Blender with a window, with real drag and drop.

    make test-gui DRIVERS=drop

Runs inside that Blender; `bgui` comes with the tool, and `drop_files.py` drops the files.
"""

import subprocess
from pathlib import Path

import bgui
import bpy
from driver_scene import empty_scene, settle, until_done

FOLDER = Path(__file__).parent
IN_VIEW = 400, 350  # pixels from the lower left corner of the 3D View


def drop(*names):
    """Drop files; Blender answers while the driver waits."""
    view = bgui.region("WINDOW")
    column, row = view.x + IN_VIEW[0], bgui.window().height - view.y - IN_VIEW[1]
    paths = [str(FOLDER / name) for name in names]
    dropping = subprocess.Popen([
        "python3",
        str(FOLDER / "drop_files.py"),
        str(column),
        str(row),
        *paths,
    ])
    while dropping.poll() is None:
        yield 0.1
    assert dropping.returncode == 0, "Blender took no files"
    yield 1.5


def confirm():
    """Press the button that the pointer is on: that of a dialog, or of Blender's menu."""
    yield from bgui.key("Return")
    yield 1.0


def imported(name, n_objects):
    yield from until_done()
    yield from settle()
    armature = bpy.context.view_layer.objects.active
    assert armature.name == name and armature.animation_data.action.name == name
    assert len(bpy.data.objects) == n_objects and armature.mode == "POSE"
    bgui.shot(f"{n_objects}-{name}.png")


def steps():
    empty_scene()
    bpy.ops.ed.undo_push(message="empty")
    yield from bgui.open_sidebar("Mocap")
    yield from drop("walk.bvh")
    bgui.shot("1-dialog.png")
    yield from confirm()
    yield from imported("walk", 1)

    yield from drop("Jump.fbx")  # Blender's own importer takes such files, too
    bgui.shot("2-menu.png")
    yield from confirm()
    bgui.shot("2-dialog.png")
    yield from confirm()
    yield from imported("Jump", 2)

    yield from drop("actor.asf", "kick.amc")
    bgui.shot("3-dialog.png")
    yield from confirm()
    yield from imported("kick", 3)

    for names in ({"walk", "Jump"}, {"walk"}, set()):
        with bgui.override("WINDOW"):
            bpy.ops.ed.undo()
        yield 0.5
        assert set(bpy.data.objects.keys()) == names
    assert bpy.context.scene.render.fps == 24


bgui.run(steps, timeout=600)
