"""What the drivers have in common. Runs in the Blender with a window, as they do."""

import bgui
import bpy

PANELS = "MOCAP_PT_"


def empty_scene():
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)


def unfold_alone(name):
    """Hide all other panels, and unfold this one, before the tab is first drawn."""
    alone = getattr(bpy.types, f"{PANELS}{name}")
    for other in [each for each in dir(bpy.types) if each.startswith(PANELS)]:
        if other != alone.__name__:
            getattr(bpy.types, other).poll = classmethod(lambda cls, context: False)
    bpy.utils.unregister_class(alone)
    alone.bl_options = set()
    bpy.utils.register_class(alone)


def settle(times=3):
    """Wait until everything is drawn."""
    for _ in range(times):
        bgui.redraw()
        yield 0.5
