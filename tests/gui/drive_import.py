"""Bring recordings into a Blender with a window, as an animator does, and take pictures.

    make extension-plain
    BG_DEBS="python3-scipy python3-pil" BG_FILES="walk.bvh joints.txt markers.trc" \
        bash ../shared/tools/blender-gui.sh run dist/mocap_assist-0.1.0-plain.zip \
        tests/gui/drive_import.py build/gui/import.png

Runs inside that Blender; `bgui` comes with the tool and moves a real pointer. The three files,
named on the command line, are copied beside this script.
"""

from pathlib import Path

import bgui
import bpy

FOLDER = Path(__file__).parent
WALK, JOINTS, MARKERS = (FOLDER / name for name in ("walk.bvh", "joints.txt", "markers.trc"))
IMPORT = "mocap_assist.import_recording"


def settle():
    """Wait until everything is drawn."""
    for _ in range(3):
        bgui.redraw()
        yield 0.5


def look_at(center, distance):
    view = bgui.area().spaces.active.region_3d
    view.view_location = center
    view.view_rotation = (0.76, 0.62, 0.13, 0.15)
    view.view_distance = distance
    view.view_perspective = "ORTHO"


def drop(*paths):
    """What Blender does when files are dropped: the dialog opens."""
    files = [{"name": path.name} for path in paths]
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            "INVOKE_DEFAULT", directory=str(FOLDER), files=files
        )


def steps():
    # The dialog after a drop, joints and markers in the scene, and the file browser.
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    yield from bgui.open_sidebar("Mocap")
    bgui.move(500, 500)
    drop(JOINTS)
    yield 1.5
    bgui.shot("1-dialog.png")
    yield from bgui.key("Return")
    yield 1.0
    body = bpy.context.object
    assert body is not None and body.type == "ARMATURE", body
    bpy.context.scene.frame_set(20)
    with bgui.override("WINDOW"):
        bpy.ops.object.mode_set(mode="POSE")
    look_at(body.matrix_world @ body.pose.bones[0].head, 4.0)
    yield from settle()
    bgui.shot("2-joints.png")
    with bgui.override("WINDOW"):
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.mocap_assist.import_recording(
            directory=str(FOLDER), files=[{"name": MARKERS.name}, {"name": WALK.name}]
        )
    assert len(bpy.data.armatures) == 2
    bpy.context.scene.frame_set(40)
    look_at((0.0, 0.0, 0.8), 8.0)
    yield from settle()
    bgui.shot("3-all.png")
    yield from bgui.scan()
    yield from bgui.hover(*bgui.at(IMPORT))
    bgui.shot("4-tooltip.png")
    yield from bgui.click(*bgui.at(IMPORT))
    yield 2.0
    bgui.shot("5-browser.png")


bgui.run(steps, timeout=300)
