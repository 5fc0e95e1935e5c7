"""Bring a recording of depth into a Blender with a window, play it, and take pictures.

    make test-gui DRIVERS=depth

Runs inside that Blender; `bgui` comes with the tool. The recording, such as one of
`../shared/data/depth/truth`, is copied next to this script.
"""

import time
from pathlib import Path

import bgui
import bpy
from driver_scene import empty_scene, settle

FOLDER = Path(__file__).parent
WALK = FOLDER / "walk.npz"
UNTIL_DONE = 600  # tenths of a second


def look_at(center, distance, rotation):
    view = bgui.area().spaces.active.region_3d
    view.view_location = center
    view.view_rotation = rotation
    view.view_distance = distance
    view.view_perspective = "PERSP"


def bring_in():
    """Drop the file; the dialog opens, and Return imports it in a process of its own."""
    bgui.move(500, 500)
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            "INVOKE_DEFAULT", directory=str(FOLDER), files=[{"name": WALK.name}]
        )
    yield 1.5
    bgui.shot("1-dialog.png")
    yield from bgui.key("Return")
    job = bpy.context.window_manager.mocap_assist_job
    for _ in range(UNTIL_DONE):
        yield 0.1
        if not job.running and bpy.context.object is not None:
            break


def steps():
    # A walk seen from next to the camera, at three frames, and while it plays.
    empty_scene()
    yield from bgui.open_sidebar("Mocap")
    yield from bring_in()
    made = bpy.context.object
    assert made.type == "MESH", made
    look_at((0.0, 3.0, 0.0), 5.0, (0.70, 0.66, 0.18, 0.20))
    shown = []
    for number, frame in enumerate((1, 20, 50), start=2):
        bpy.context.scene.frame_set(frame)
        yield from settle()
        bgui.shot(f"{number}-frame-{frame}.png")
        shown.append(tuple(made.data.vertices[0].co))
    assert len(set(shown)) > 1, shown
    started = time.perf_counter()
    for frame in range(1, 31):
        bpy.context.scene.frame_set(frame)
    print(f"30 frames in {time.perf_counter() - started:.2f} s without drawing")
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo_push(message="Frames")
        bpy.ops.object.delete()
        bpy.ops.ed.undo()
    yield from settle()
    bpy.context.scene.frame_set(40)
    yield from settle()
    bgui.shot("5-after-undo.png")
    assert [each.name for each in bpy.data.objects] == ["walk"]


bgui.run(steps, timeout=1500)
