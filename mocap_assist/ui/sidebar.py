"""The sidebar's tab, in the three editors in which an animator looks at motion."""

import bpy

from .check_panel import CheckPanel, MOCAP_UL_spots
from .clean_panel import CleanPanel
from .compare_panel import ComparePanel
from .feet_panel import FeetPanel
from .import_panel import ImportPanel
from .library_panel import LibraryPanel
from .markers_panel import MarkersPanel
from .perform_panel import PerformPanel
from .physics_panel import PhysicsPanel
from .preferences import preferred
from .reconstruct_panel import ReconstructPanel
from .retarget_panel import RetargetPanel
from .track_panel import TrackPanel
from .vary_panel import VaryPanel

EDITORS = {"": "VIEW_3D", "_graph": "GRAPH_EDITOR", "_dopesheet": "DOPESHEET_EDITOR"}
TAB = "Mocap"


def _in_every_editor(body: type) -> list[type[bpy.types.Panel]]:
    """Return a panel class for each editor: Blender ties a class to one kind of editor."""
    name = f"MOCAP_PT_{body.__name__.removesuffix('Panel').lower()}"
    shared = {"bl_region_type": "UI", "bl_category": TAB}
    return [
        type(f"{name}{suffix}", (body, bpy.types.Panel), {"bl_space_type": editor} | shared)
        for suffix, editor in EDITORS.items()
    ]


BODIES = (
    ImportPanel,
    TrackPanel,
    ReconstructPanel,
    CleanPanel,
    CheckPanel,
    ComparePanel,
    FeetPanel,
    PhysicsPanel,
    MarkersPanel,
    RetargetPanel,
    LibraryPanel,
    VaryPanel,
    PerformPanel,
)
PANELS = [panel for body in BODIES for panel in _in_every_editor(body)]


def register() -> None:
    """Show the panels, on the tab that the preferences name."""
    bpy.utils.register_class(MOCAP_UL_spots)
    tab = preferred("tab").strip() or TAB
    for panel in PANELS:
        panel.bl_category = tab
        bpy.utils.register_class(panel)


def unregister() -> None:
    """Take the panels away."""
    for panel in reversed(PANELS):
        bpy.utils.unregister_class(panel)
    bpy.utils.unregister_class(MOCAP_UL_spots)


def move_to_tab() -> None:
    """Show the panels again, on another tab: Blender reads it only when they are registered."""
    unregister()
    register()
