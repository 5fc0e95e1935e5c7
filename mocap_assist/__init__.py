"""Everything that knows what a Blender scene is.

Blender is imported only on `register`: a solve in a process of its own passes through here.
"""


def register() -> None:
    """Make properties, commands and panels known to Blender."""
    from . import batch, former_settings, scene_properties, ui
    from .actions import contact_keys
    from .check import delta_influence, raw_view
    from .depth import depth_preview
    from .find_similar import gallery_drawing, ghost_drawing, previews, properties
    from .library import auto_update, background
    from .live import listening
    from .runtime import watch
    from .track import body_overlay

    scene_properties.register()
    former_settings.register()
    properties.register()
    ghost_drawing.register()
    gallery_drawing.register()
    background.register()
    auto_update.register()
    previews.register()
    contact_keys.register()
    depth_preview.register()
    body_overlay.register()
    watch.register()
    raw_view.register()
    delta_influence.register()
    listening.register()
    batch.register()
    ui.register()


def unregister() -> None:
    """Unregister all parts of the extension."""
    from . import batch, former_settings, scene_properties, ui
    from .actions import contact_keys
    from .check import delta_influence, raw_view
    from .depth import depth_preview
    from .find_similar import gallery_drawing, ghost_drawing, previews, properties
    from .library import auto_update, background
    from .live import listening
    from .panel_parts import solver_ready
    from .runtime import watch
    from .track import body_overlay

    ui.unregister()
    solver_ready.unregister()
    batch.unregister()
    listening.unregister()
    delta_influence.unregister()
    raw_view.unregister()
    watch.unregister()
    body_overlay.unregister()
    depth_preview.unregister()
    contact_keys.unregister()
    previews.unregister()
    auto_update.unregister()
    background.unregister()
    gallery_drawing.unregister()
    ghost_drawing.unregister()
    properties.unregister()
    former_settings.unregister()
    scene_properties.unregister()
