"""Make a skeleton from markers in a Blender with a window, as an animator does; take pictures.

    make test-gui DRIVERS=markers

Runs inside that Blender; `bgui` comes with the tool. The take, with Plug-in-Gait or CMU
markers, is copied next to this script.
"""

from pathlib import Path

import bgui
import bpy
from driver_scene import empty_scene, settle, unfold_alone

FOLDER = Path(__file__).parent
MARKERS = FOLDER / "markers.c3d"


def steps():
    # The panels of markers, and the skeleton that is made of them.
    empty_scene()
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            directory=str(FOLDER), files=[{"name": MARKERS.name}]
        )
    unfold_alone("markers")
    yield from bgui.open_sidebar("Mocap")
    bpy.context.scene.frame_set(60)
    view = bgui.area().spaces.active
    view.region_3d.view_location = (0.0, 0.0, 0.9)
    view.region_3d.view_distance = 6.0
    yield from settle()
    bgui.shot("1-markers.png")
    with bgui.override("WINDOW"):
        assert bpy.ops.mocap_assist.solve_skeleton() == {"FINISHED"}
    body = bpy.context.object
    assert body.type == "ARMATURE"
    view.region_3d.view_location = body.matrix_world @ body.pose.bones[0].head
    view.region_3d.view_distance = 2.6
    yield from settle()
    bgui.shot("2-skeleton.png")


bgui.run(steps, timeout=1500)
