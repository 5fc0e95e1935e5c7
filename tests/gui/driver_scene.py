"""What the drivers have in common. Runs in the Blender with a window, as they do."""

import bgui
import bpy

PANELS = "MOCAP_PT_"
UNTIL_DONE = 1800  # tenths of a second
WHEEL_UP, WHEEL_DOWN = 4, 5
TOP = (1152, 872)
"""Of the tab: scrolled from there, no list comes under the mouse, which it would scroll."""


def empty_scene():
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)


def unfold_alone(name):
    """Hide all other panels, and unfold this one, before the tab is first drawn."""
    bpy.context.window_manager.mocap_assist_all_panels = True
    for each in [other for other in dir(bpy.types) if other.startswith(PANELS)]:
        panel = getattr(bpy.types, each)
        bpy.utils.unregister_class(panel)
        if each == f"{PANELS}{name}":
            panel.bl_options = set()
        else:
            panel.poll = classmethod(lambda cls, context: False)
        bpy.utils.register_class(panel)


def settle(times=3, pointer=None):
    """Wait until everything is drawn; move the pointer off the buttons before, if given."""
    if pointer:
        bgui.move(*pointer)
    for _ in range(times):
        bgui.redraw()
        yield 0.5


def scroll(wheel):
    """Show the end of the tab, or its beginning."""
    bgui.move(*TOP)
    for _ in range(40):
        bgui.x("click", wheel)
        yield 0.05
    yield from settle()


def until_done():
    """Wait until the running import or solve has ended."""
    job = bpy.context.window_manager.mocap_assist_job
    for _ in range(UNTIL_DONE):
        yield 0.1
        if not job.running:
            return
    raise AssertionError(f"{job.message} {job.fraction}")
