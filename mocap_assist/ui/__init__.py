"""What the animator sees: panels in the sidebar, menus, preferences and the overlay."""

from . import (
    bone_list,
    example_list,
    heat_switch,
    import_menu,
    library_panel,
    manual,
    menus,
    overlay_switch,
    preferences,
    retarget_panel,
    sidebar,
    source_list,
    translations,
    vary_panel,
)

PARTS = (
    translations,
    preferences,
    example_list,
    bone_list,
    retarget_panel,
    source_list,
    library_panel,
    vary_panel,
    sidebar,
    menus,
    import_menu,
    overlay_switch,
    heat_switch,
    manual,
)


def register() -> None:
    """Show everything."""
    for part in PARTS:
        part.register()


def unregister() -> None:
    """Take everything away again."""
    for part in reversed(PARTS):
        part.unregister()
