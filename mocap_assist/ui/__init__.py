"""The sidebar tab, menus, preferences, the workspace and the manual."""

from .. import languages
from ..check import issue_views, key_map, list_over_undo, renewing
from ..clean import example_list
from ..exporting import menu as export_menu
from ..find_similar import match_grid
from ..find_similar import panel as library_panel
from ..fix import queue
from ..importing import menu as import_menu
from ..library import source_list
from ..overlays import color_icons, confidence_switch
from ..overlays.comparison import raw_curves_switch
from ..overlays.comparison import switches as overlay_switch
from ..overlays.contacts import switch as contact_switch
from ..overlays.strip import switch as strip_switch
from ..panel_parts import presets
from ..retarget import action_ticks, bone_highlight, bone_list, rest_preview
from ..variants import panel as vary_panel
from . import diagnostics, manual, menus, preferences, sidebar

PARTS = (
    languages,
    diagnostics,
    preferences,
    color_icons,
    example_list,
    bone_highlight,
    rest_preview,
    bone_list,
    action_ticks,
    source_list,
    match_grid,
    library_panel,
    vary_panel,
    presets,
    sidebar,
    menus,
    import_menu,
    export_menu,
    overlay_switch,
    confidence_switch,
    contact_switch,
    raw_curves_switch,
    strip_switch,
    issue_views,
    renewing,
    list_over_undo,
    queue,
    key_map,
    manual,
)


def register() -> None:
    """Register everything."""
    for part in PARTS:
        part.register()


def unregister() -> None:
    """Unregister everything."""
    for part in reversed(PARTS):
        part.unregister()
