"""Clean markers in a Blender with a window, and show them raw and clean; take a picture.

    make test-gui DRIVERS=marker_overlay

Runs inside that Blender; `bgui` comes with the tool. The take, best with noise and gaps, is
copied next to this script.
"""

from pathlib import Path

import bgui
import bpy
from driver_scene import empty_scene, settle

FOLDER = Path(__file__).parent
MARKERS = FOLDER / "markers.trc"


def steps():
    # A take in a gap of some markers; trails of the others, raw and clean.
    empty_scene()
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            directory=str(FOLDER), files=[{"name": MARKERS.name}]
        )
        assert bpy.ops.mocap_assist.denoise() == {"FINISHED"}
    bpy.context.window_manager.mocap_assist_overlay = True
    yield from bgui.open_sidebar("Mocap")
    first, last = bpy.context.selected_objects[0].animation_data.action.curve_frame_range
    bpy.context.scene.frame_set(round((first + last) / 2.0))
    view = bgui.area().spaces.active
    markers = [marker.matrix_world.translation for marker in bpy.context.selected_objects]
    view.region_3d.view_location = sum(markers[1:], markers[0]) / len(markers)
    view.region_3d.view_distance = 3.0
    yield from settle()
    bgui.shot("1-marker-overlay.png")


bgui.run(steps, timeout=1500)
