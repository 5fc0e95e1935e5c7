"""Make a skeleton from markers in a Blender with a window, as an animator does; take pictures.

    make extension-plain
    BG_DEBS="python3-scipy python3-pil" BG_FILES=markers.c3d \
        bash ../shared/tools/blender-gui.sh run dist/mocap_assist-0.1.0-plain.zip \
        tests/gui/drive_markers.py build/gui/markers.png

Runs inside that Blender; `bgui` comes with the tool. The take, with Plug-in-Gait or CMU
markers, is copied beside this script.
"""

from pathlib import Path

import bgui
import bpy

FOLDER = Path(__file__).parent
MARKERS = FOLDER / "markers.c3d"


def settle():
    """Wait until everything is drawn."""
    for _ in range(3):
        bgui.redraw()
        yield 0.5


def unfold_markers_alone():
    """Take the other panels away, and unfold this one, before the tab is first drawn."""
    for name in ("import", "check", "compare", "feet", "retarget"):
        bpy.utils.unregister_class(getattr(bpy.types, f"MOCAP_PT_{name}"))
    panel = bpy.types.MOCAP_PT_markers
    bpy.utils.unregister_class(panel)
    panel.bl_options = set()
    bpy.utils.register_class(panel)


def steps():
    # The panels of markers, and the skeleton that is made of them.
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            directory=str(FOLDER), files=[{"name": MARKERS.name}]
        )
    unfold_markers_alone()
    yield from bgui.open_sidebar("Mocap")
    bpy.context.scene.frame_set(60)
    view = bgui.area().spaces.active
    view.overlay.show_relationship_lines = False
    view.region_3d.view_location = (0.0, 0.0, 0.9)
    view.region_3d.view_distance = 6.0
    yield from settle()
    bgui.shot("1-markers.png")
    with bgui.override("WINDOW"):
        assert bpy.ops.mocap_assist.solve_skeleton() == {"FINISHED"}
    assert bpy.context.object.type == "ARMATURE"
    yield from settle()
    bgui.shot("2-skeleton.png")


bgui.run(steps, timeout=300)
