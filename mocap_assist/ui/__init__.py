"""What the animator sees: panels in the sidebar, menus, preferences and the overlay."""

from . import (
    example_list,
    import_menu,
    manual,
    menus,
    overlay_switch,
    preferences,
    sidebar,
    translations,
)

PARTS = (
    translations,
    preferences,
    example_list,
    sidebar,
    menus,
    import_menu,
    overlay_switch,
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
