"""The tab of the sidebar that holds all panels."""

import bpy

from .preference_values import preference_value

TAB = "Mocap"


def tab_name() -> str:
    """Return the name of the tab from the preferences."""
    return str(preference_value("tab")).strip() or TAB


def is_tab_open(screen: bpy.types.Screen) -> bool:
    """Return whether an editor of a window shows the tab."""
    sidebars = (
        region
        for area in screen.areas
        if getattr(area.spaces.active, "show_region_ui", False)
        for region in area.regions
        if region.type == "UI"
    )
    # Blender has no tabs before the sidebar was drawn.
    return any(getattr(each, "active_panel_category", "") == tab_name() for each in sidebars)
