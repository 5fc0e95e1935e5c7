"""Sidebar tab in the three editors for motion."""

import bpy

from ..check.compare_panel import ComparePanel
from ..check.panel import CheckPanel, MOCAP_UL_issues
from ..clean.feet_panel import FeetPanel
from ..clean.panel import CleanPanel
from ..find_similar.panel import LibraryPanel
from ..fix.panel import FixPanel, MOCAP_UL_takes
from ..importing.panel import ImportPanel
from ..live.panel import PerformPanel
from ..markers.panel import MarkersPanel
from ..panel_parts.sidebar_tab import TAB, tab_name
from ..physics.panel import PhysicsPanel
from ..reconstruct.panel import ReconstructPanel
from ..retarget.panel import RetargetPanel
from ..track.follow_panel import TrackLivePanel
from ..track.panel import TrackPanel
from ..variants.panel import VaryPanel

EDITORS = {"": "VIEW_3D", "_graph": "GRAPH_EDITOR", "_dopesheet": "DOPESHEET_EDITOR"}


def _in_every_editor(body: type) -> list[type[bpy.types.Panel]]:
    """Return a panel class for each editor: Blender ties a class to one kind of editor."""
    name, shared = _name(body), {"bl_region_type": "UI", "bl_category": TAB}
    found = []
    for suffix, editor in EDITORS.items():
        own = {"bl_space_type": editor, **shared}
        if body in PARENTS:
            own["bl_parent_id"] = f"{_name(PARENTS[body])}{suffix}"
        found.append(type(f"{name}{suffix}", (body, bpy.types.Panel), own))
    return found


def _name(body: type) -> str:
    return f"MOCAP_PT_{body.__name__.removesuffix('Panel').lower()}"


PARENTS = {ComparePanel: CleanPanel, FeetPanel: CleanPanel}
"""Panels within others."""
BODIES = (
    ImportPanel,
    FixPanel,
    CheckPanel,
    TrackPanel,
    TrackLivePanel,
    MarkersPanel,
    ReconstructPanel,
    CleanPanel,
    ComparePanel,
    FeetPanel,
    PhysicsPanel,
    RetargetPanel,
    LibraryPanel,
    VaryPanel,
    PerformPanel,
)
"""In the order of the work, each after the one that it is within."""
LISTS = (MOCAP_UL_issues, MOCAP_UL_takes)
PANELS = [panel for body in BODIES for panel in _in_every_editor(body)]


def register() -> None:
    """Show the panels, on the tab that the preferences name."""
    for each in LISTS:
        bpy.utils.register_class(each)
    for panel in PANELS:
        panel.bl_category = tab_name()
        bpy.utils.register_class(panel)


def unregister() -> None:
    """Remove the panels."""
    for panel in reversed(PANELS):
        bpy.utils.unregister_class(panel)
    for each in LISTS:
        bpy.utils.unregister_class(each)


def move_to_tab() -> None:
    """Show the panels again, on another tab: Blender reads it only when they are registered."""
    unregister()
    register()
