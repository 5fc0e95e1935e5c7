"""Read the extension's preferences."""

from typing import Any

import bpy

EXTENSION = __package__.rsplit(".", 2)[0]  # Blender knows preferences by the root package


def preferences() -> bpy.types.AddonPreferences | None:
    """Return the preferences; none where the extension was switched on for one session alone.

    Blender does so for `--addons`, and stores no preferences for such add-ons.
    """
    ours = bpy.context.preferences.addons.get(EXTENSION)
    return None if ours is None else ours.preferences


def preference_value(name: str) -> Any:
    """Return one preference, or its default."""
    ours = preferences()
    if ours is not None:
        return getattr(ours, name)
    described = bpy.types.AddonPreferences.bl_rna_get_subclass_py("MOCAP_AP_preferences")
    return described.__annotations__[name].keywords["default"]
