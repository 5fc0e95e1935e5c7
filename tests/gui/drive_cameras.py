"""Track an actor before two cameras in a Blender with a window, and take pictures.

    make test-gui DRIVERS=cameras

Runs inside that Blender; `bgui` comes with the tool. The recordings are made by the benchmarks.
"""

from pathlib import Path

import bgui
import bpy
import numpy as np
from driver_scene import empty_scene, settle, unfold_alone

FOLDER = Path(__file__).parent
UNTIL_DONE = 8000  # tenths of a second
ABOVE = (0.85, 0.45, 0.13, 0.24)
MAX_DISTANCE_M = 0.25
"""Between the middles of what two cameras show of one actor: they see opposite surfaces."""

MAX_MOVED_M = 0.01
"""After an undo: it restores the points, in other floats."""


def imported(name):
    assert bpy.ops.mocap_assist.import_recording(filepath=str(FOLDER / name)) == {"FINISHED"}
    return bpy.context.object


def middle(points):
    """Return the mean of the points that are shown, in the scene."""
    mesh = points.data
    shown = np.zeros(len(mesh.vertices), dtype=bool)
    mesh.attributes["seen"].data.foreach_get("value", shown)
    positions = np.array([vertex.co for vertex in mesh.vertices])[shown]
    matrix = np.array(points.matrix_world)
    return positions.mean(axis=0) @ matrix[:3, :3].T + matrix[:3, 3]


def track():
    """Press the button, and take a picture while the first camera is tracked."""
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo_push(message="Before")
        bpy.ops.mocap_assist.track_depth("INVOKE_DEFAULT")
    job = bpy.context.window_manager.mocap_assist_job
    shots = {"Tracking": "3-tracking.png", "Joining": "4-joining.png"}
    for _ in range(UNTIL_DONE):
        yield 0.1
        if (word := job.message.partition(" ")[0]) in shots:
            yield 0.5
            bgui.shot(shots.pop(word))
        if not job.running:
            break
    assert not shots, f"these status texts did not appear: {list(shots)}"


def prepare():
    """Import both recordings and look at them from above."""
    empty_scene()
    bpy.context.scene.render.fps = 30
    unfold_alone("track")
    yield from bgui.open_sidebar("Mocap")
    front, side = imported("front.npz"), imported("side.npz")
    view = bgui.area().spaces.active.region_3d
    view.view_location, view.view_rotation = (0.0, 3.0, 0.0), ABOVE
    view.view_distance, view.view_perspective = 6.0, "PERSP"
    track_settings = bpy.context.scene.mocap_assist.track
    track_settings.backward = track_settings.refine = False
    track_settings.other_cameras = True
    bpy.context.scene.frame_set(20)
    return front, side


def select(front, side):
    """Select the first camera, then both, and take pictures of the panel."""
    side.select_set(False)
    front.select_set(True)
    bpy.context.view_layer.objects.active = front
    yield from settle()
    bgui.shot("1-one-selected.png")
    side.select_set(True)
    yield from settle()
    bgui.shot("2-two-cameras.png")


def undo(before):
    """One undo takes the armature away and the points back."""
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo()
    yield from settle()
    assert {each.type for each in bpy.data.objects} == {"MESH"}
    front, side = (bpy.data.objects[name] for name in ("front", "side"))
    assert abs(np.linalg.norm(middle(front) - middle(side)) - before) < MAX_MOVED_M
    bgui.shot("7-undone.png")


def steps():
    front, side = yield from prepare()
    yield from select(front, side)
    before = np.linalg.norm(middle(front) - middle(side))
    yield from track()
    assert bpy.context.object.type == "ARMATURE", bpy.context.object
    bpy.context.scene.frame_set(20)
    yield from settle()
    bgui.shot("5-joined.png")
    distance = np.linalg.norm(middle(front) - middle(side))
    print(f"bgui: the middles were {before:.2f} m apart and are {distance:.2f} m")
    assert distance < MAX_DISTANCE_M
    bpy.context.scene.frame_set(34)
    yield from settle()
    bgui.shot("6-later.png")
    yield from undo(before)


bgui.run(steps, timeout=1500)
