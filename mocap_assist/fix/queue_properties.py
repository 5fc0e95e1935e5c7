"""The list of takes that Fix My Take works on, in the window manager, which is never saved."""

import bpy


class MOCAP_PG_queued_take(bpy.types.PropertyGroup):
    """A take in the list of the sidebar."""

    status: bpy.props.StringProperty(name="Status")
    note: bpy.props.StringProperty(name="Text")
    results: bpy.props.StringProperty(name="Results")


class MOCAP_PG_fix_queue(bpy.types.PropertyGroup):
    """The takes that are fixed one after another."""

    takes: bpy.props.CollectionProperty(type=MOCAP_PG_queued_take)
    active_take: bpy.props.IntProperty(name="Take", description="Take whose result is shown")
    paused: bpy.props.BoolProperty(
        name="Pause", description="Wait before the next take; the running one is finished"
    )


PROPERTIES = (MOCAP_PG_queued_take, MOCAP_PG_fix_queue)
