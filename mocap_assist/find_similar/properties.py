"""The matches that the sidebar lists: neither undo nor files touch the window manager."""

import bpy


class MOCAP_PG_match(bpy.types.PropertyGroup):
    """A clip that is similar to the query; `name` is the clip's."""

    score: bpy.props.FloatProperty(name="Score", subtype="FACTOR", min=0.0, max=1.0)
    start: bpy.props.IntProperty(name="First Frame", description="Frame of the clip")
    stop: bpy.props.IntProperty(name="Last Frame", description="Frame of the clip")
    tags: bpy.props.StringProperty(name="Tags")


class MOCAP_PG_matches(bpy.types.PropertyGroup):
    """Result of the last search."""

    search: bpy.props.IntProperty(name="Search", description="Number of the search")
    query: bpy.props.StringProperty(name="Query", description="Action that was searched for")
    rows: bpy.props.CollectionProperty(type=MOCAP_PG_match)
    active: bpy.props.IntProperty(name="Match", description="Selected clip")


class MOCAP_PG_indexing(bpy.types.PropertyGroup):
    """Progress of the running Build Library, and the result of the last one."""

    running: bpy.props.BoolProperty(name="Running")
    fraction: bpy.props.FloatProperty(name="Done", subtype="FACTOR", min=0.0, max=1.0)
    message: bpy.props.StringProperty(name="Message")
    report: bpy.props.StringProperty(
        name="Report", description="Result of the last Build Library"
    )


CLASSES = (MOCAP_PG_match, MOCAP_PG_matches, MOCAP_PG_indexing)


def register() -> None:
    """Add the properties."""
    for each in CLASSES:
        bpy.utils.register_class(each)
    manager = bpy.types.WindowManager
    manager.mocap_assist_matches = bpy.props.PointerProperty(type=MOCAP_PG_matches)
    manager.mocap_assist_indexing = bpy.props.PointerProperty(type=MOCAP_PG_indexing)


def unregister() -> None:
    """Remove the properties."""
    del bpy.types.WindowManager.mocap_assist_indexing
    del bpy.types.WindowManager.mocap_assist_matches
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
