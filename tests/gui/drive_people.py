"""Track two people in a Blender with a window, and take pictures.

    make test-gui DRIVERS=people

Runs inside that Blender; `bgui` comes with the tool. The recording is made by the benchmarks.
"""

from pathlib import Path

import bgui
import bpy
from driver_scene import empty_scene, settle, unfold_alone, until_done

FOLDER = Path(__file__).parent
FRONT = (0.70, 0.66, 0.18, 0.20)


def prepare():
    """Import the recording, look at it and at the panel."""
    empty_scene()
    bpy.context.scene.render.fps = 30
    unfold_alone("track")
    yield from bgui.open_sidebar("Mocap")
    path = str(FOLDER / "two.npz")
    assert bpy.ops.mocap_assist.import_recording(filepath=path) == {"FINISHED"}
    view = bgui.area().spaces.active.region_3d
    view.view_location, view.view_rotation = (0.0, 3.0, 0.0), FRONT
    view.view_distance, view.view_perspective = 5.0, "PERSP"
    settings = bpy.context.scene.mocap_assist.track
    settings.all_people, settings.backward, settings.refine = True, False, False
    bpy.context.scene.frame_set(20)
    yield from settle()
    bgui.shot("1-all-people.png")


def steps():
    yield from prepare()
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo_push(message="Before")
        bpy.ops.mocap_assist.track_depth("INVOKE_DEFAULT")
    yield from until_done()
    armatures = [each for each in bpy.data.objects if each.type == "ARMATURE"]
    assert len(armatures) == 2, [each.name for each in bpy.data.objects]
    assert bpy.context.object.name == "two tracked person 1", bpy.context.object
    for number, frame in ((2, 1), (3, 20), (4, 40)):
        bpy.context.scene.frame_set(frame)
        yield from settle()
        bgui.shot(f"{number}-frame-{frame}.png")
    bpy.context.window_manager.mocap_assist_body = True
    yield from settle()
    bgui.shot("5-body-overlay.png")
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo()
    yield from settle()
    assert [each.type for each in bpy.data.objects] == ["MESH"]


bgui.run(steps, timeout=1500)
