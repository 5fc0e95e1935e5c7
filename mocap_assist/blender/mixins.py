"""Attributes that Blender's base classes give to our mix-ins."""

from typing import TYPE_CHECKING, Any

import bpy

from ...solvers.settings import Settings
from ..languages import CONTEXT


class OperatorMixin:
    """Mixed in before bpy.types.Operator."""

    bl_translation_context = CONTEXT

    if TYPE_CHECKING:
        bl_idname: str
        layout: bpy.types.UILayout
        properties: bpy.types.OperatorProperties

        @classmethod
        def poll_message_set(cls, message: str) -> None:
            """Show why the button is gray."""

        def report(self, kind: set[str], message: str) -> None:
            """Show a message in the status bar."""


class SettingsMixin(OperatorMixin):
    """An operator that the decorator `settings_from` gives a property for each setting."""

    if TYPE_CHECKING:
        setting_names: tuple[str, ...]

        def settings(self) -> Any:
            """Return the bundle with the checked values of the properties."""

        def set_properties(self, *values: Settings) -> None:
            """Give the properties the values of some settings."""


class PanelMixin:
    """Mixed in before bpy.types.Panel."""

    bl_translation_context = CONTEXT

    if TYPE_CHECKING:
        layout: bpy.types.UILayout
