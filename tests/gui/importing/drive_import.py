"""Bring recordings into a Blender with a window, as an animator does, and take pictures.

A long recording is cancelled while it is read, and the file browser brings one in.

    make test-gui DRIVERS=import

Runs inside that Blender; `bgui` comes with the tool and moves a real pointer. The three files,
named on the command line, are copied next to this script.
"""

from pathlib import Path

import bgui
import bpy
from driver_scene import UNTIL_DONE, empty_scene, settle, until_done

FOLDER = Path(__file__).parent
WALK, JOINTS, MARKERS = (FOLDER / name for name in ("walk.bvh", "joints.txt", "markers.trc"))
LONG = FOLDER / "long.bvh"
LENGTHS = 100  # of the walk, in the long recording
IMPORT = "mocap_assist.import_recording"


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


def make_long():
    """Let the walk go on and on: some seconds of reading."""
    head, found, frames = WALK.read_bytes().partition(b"Frame Time")
    time, _, rows = frames.partition(b"\n")
    LONG.write_bytes(head + found + time + b"\n" + rows * LENGTHS)


def job():
    return bpy.context.window_manager.mocap_assist_job


def everything():
    """What must be as it was after a cancelled import."""
    active = bpy.context.view_layer.objects.active
    return (
        sorted(each.name for each in bpy.data.objects),
        sorted(each.name for each in bpy.data.actions),
        sorted(each.name for each in bpy.data.armatures),
        [each.name for each in bpy.context.view_layer.objects.selected],
        active.name,
        active.mode,
    )


def cancel_a_long_one():
    """In Pose Mode: it stays, and so does all else."""
    with bgui.override("WINDOW"):
        bpy.ops.object.mode_set(mode="POSE")
    before = everything()
    bgui.move(500, 500)
    drop(LONG)
    yield 1.5
    yield from bgui.key("Return")
    for _ in range(UNTIL_DONE):
        yield 0.1
        if job().running and job().fraction > 0.05:
            break
    assert job().message == f"Reading {LONG.name}", job().message
    bgui.shot("6-reading.png")
    yield from bgui.key("Escape")
    yield 0.5
    assert not job().running
    assert everything() == before, (everything(), before)
    bgui.shot("7-cancelled.png")


def browse():
    """Choose the walk in the file browser that the button opened, and undo that one step."""
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo_push(message="What scripts have done so far")
    before = {each.name for each in bpy.data.objects}
    window = bpy.context.window_manager.windows[-1]
    area = next(each for each in window.screen.areas if each.type == "FILE_BROWSER")
    region = next(each for each in area.regions if each.type == "WINDOW")
    area.spaces.active.params.directory = str(FOLDER).encode()
    area.spaces.active.params.filename = WALK.name
    yield 1.0
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.file.execute()
    yield 0.3
    yield from until_done()
    made = [each for each in bpy.data.objects if each.name not in before]
    assert [each.type for each in made] == ["ARMATURE"], made
    last = bpy.context.window_manager.operators[-1]
    assert last.bl_idname == "MOCAP_ASSIST_OT_import_job", last.bl_idname
    yield from settle()
    bgui.shot("8-browsed.png")
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo()
    yield from settle()
    assert {each.name for each in bpy.data.objects} == before, list(bpy.data.objects)


def joints_after_a_dialog():
    """Drop joints of a camera; an armature comes of them."""
    bgui.move(500, 500)
    drop(JOINTS)
    yield 1.5
    bgui.shot("1-dialog.png")
    yield from bgui.key("Return")
    yield 0.5
    yield from until_done()
    body = bpy.context.object
    assert body is not None and body.type == "ARMATURE", body
    bpy.context.scene.frame_set(20)
    with bgui.override("WINDOW"):
        bpy.ops.object.mode_set(mode="POSE")
    look_at(body.matrix_world @ body.pose.bones[0].head, 4.0)
    yield from settle()
    bgui.shot("2-joints.png")


def steps():
    # The dialog after a drop, joints and markers in the scene, and the file browser.
    empty_scene()
    make_long()
    yield from bgui.open_sidebar("Mocap")
    yield from joints_after_a_dialog()
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
    yield from cancel_a_long_one()
    yield from bgui.scan()
    yield from bgui.hover(*bgui.at(IMPORT))
    bgui.shot("4-tooltip.png")
    yield from bgui.click(*bgui.at(IMPORT))
    yield 2.0
    bgui.shot("5-browser.png")
    yield from browse()


bgui.run(steps, timeout=1500)
