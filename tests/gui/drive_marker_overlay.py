"""Clean markers in a Blender with a window, and show them raw and clean; take a picture.

    make extension-plain
    BG_DEBS="python3-scipy python3-pil" BG_FILES=markers.trc \
        bash ../shared/tools/blender-gui.sh run dist/mocap_assist-0.1.0-plain.zip \
        tests/gui/drive_marker_overlay.py build/gui/marker_overlay.png

Runs inside that Blender; `bgui` comes with the tool. The take, best with noise and gaps, is
copied beside this script.
"""

from pathlib import Path

import bgui
import bpy

FOLDER = Path(__file__).parent
MARKERS = FOLDER / "markers.trc"


def settle():
    """Wait until everything is drawn."""
    for _ in range(3):
        bgui.redraw()
        yield 0.5


def steps():
    # A take in a gap of some markers; trails of the others, raw and clean.
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            directory=str(FOLDER), files=[{"name": MARKERS.name}]
        )
        assert bpy.ops.mocap_assist.denoise() == {"FINISHED"}
    bpy.context.window_manager.mocap_assist_overlay = True
    yield from bgui.open_sidebar("Mocap")
    first, last = bpy.context.object.children[0].animation_data.action.curve_frame_range
    bpy.context.scene.frame_set(round((first + last) / 2.0))
    view = bgui.area().spaces.active
    view.overlay.show_relationship_lines = False
    view.region_3d.view_location = (0.0, 0.0, 1.0)
    view.region_3d.view_distance = 1.8
    yield from settle()
    bgui.shot("1-marker-overlay.png")


bgui.run(steps, timeout=300)
