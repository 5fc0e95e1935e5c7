"""Drop takes of several makers into a Blender with a window, press Enter, and look at them.

Each comes in framed, in Pose Mode or with its markers selected, with the rate of the take.

    make test-gui DRIVERS=import_framing

Runs inside that Blender; `bgui` comes with the tool. The takes are copied next to this script.
"""

from pathlib import Path

import bgui
import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from driver_scene import empty_scene, settle, until_done

FOLDER = Path(__file__).parent
TAKES = {
    "walk.bvh": ("ARMATURE", 120),
    "mixamo.fbx": ("ARMATURE", 30),
    "kinect.txt": ("ARMATURE", 30),
    "cmu.c3d": ("EMPTY", 120),
    "gait.c3d": ("EMPTY", 100),
}


def points_of(active):
    if active.type == "ARMATURE":
        return [active.matrix_world @ bone.head for bone in active.pose.bones]
    return [each.matrix_world.translation for each in bpy.context.selected_objects]


def check_framed(active):
    """All of the actor is inside the view, and fills at least a third of its height."""
    region, view = bgui.region("WINDOW"), bgui.area().spaces.active.region_3d
    points = [location_3d_to_region_2d(region, view, point) for point in points_of(active)]
    assert all(point is not None for point in points)
    positions = np.array(points) / (region.width, region.height)
    assert (positions > 0.0).all() and (positions < 1.0).all(), (
        positions.min(0),
        positions.max(0),
    )
    assert np.ptp(positions, axis=0).max() > 0.33, np.ptp(positions, axis=0)


def bring(name):
    kind, rate = TAKES[name]
    files = [{"name": name}]
    bgui.move(700, 500)
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            "INVOKE_DEFAULT", directory=str(FOLDER), files=files
        )
    yield 2.0
    bgui.shot(f"{name}-1-dialog.png")
    yield from bgui.key("Return")
    yield 0.5
    yield from until_done()
    yield 1.0  # the view moves smoothly
    yield from settle()
    bgui.shot(f"{name}-2-imported.png")
    active, scene = bpy.context.object, bpy.context.scene
    assert active.type == kind, active
    assert scene.render.fps == rate, scene.render.fps
    assert bpy.context.mode == ("POSE" if kind == "ARMATURE" else "OBJECT")
    if kind == "EMPTY":
        assert active not in bpy.context.selected_objects
    check_framed(active)
    if kind == "ARMATURE":
        assert active.data.display_type == "STICK" and active.show_in_front
        assert [bone.name for bone in bpy.context.selected_pose_bones] == [
            active.data.bones[0].name
        ]


def steps():
    # Every take in a scene of its own.
    yield from bgui.open_sidebar("Mocap")
    for name in TAKES:
        if bpy.context.mode == "POSE":
            with bgui.override("WINDOW"):
                bpy.ops.object.mode_set(mode="OBJECT")
        empty_scene()
        bpy.context.scene.render.fps = 24
        yield from bring(name)


bgui.run(steps, timeout=1500)
