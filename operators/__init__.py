"""One module per button."""

import bpy

from .denoise import MOCAP_OT_denoise

OPERATORS = (MOCAP_OT_denoise,)


def register() -> None:
    """Make the buttons known to Blender."""
    for operator in OPERATORS:
        bpy.utils.register_class(operator)


def unregister() -> None:
    """Take the buttons away again."""
    for operator in reversed(OPERATORS):
        bpy.utils.unregister_class(operator)
