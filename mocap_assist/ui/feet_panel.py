"""Panel: when each foot stands, as keys that the animator can edit."""

from typing import ClassVar

import bpy

from ..scene.contacts import PROPERTIES
from ..selection import selected_armature
from .drawing import exists

PLANT = "mocap_assist.plant_feet"
SIDES = ("Left foot stands", "Right foot stands")


class FeetPanel:
    """The keyed contacts, and the button that plants the feet by them."""

    bl_label = "Feet"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return exists(PLANT) or _keyed(context)

    def draw(self, context: bpy.types.Context) -> None:
        layout, armature = self.layout, selected_armature(context)
        if _keyed(context):
            column = layout.column(align=True)
            for name, text in zip(PROPERTIES, SIDES, strict=True):
                column.prop(armature, f'["{name}"]', text=text)
        if exists(PLANT):
            layout.operator(PLANT, icon="CON_FLOOR")


def _keyed(context: bpy.types.Context) -> bool:
    armature = selected_armature(context)
    return armature is not None and all(name in armature for name in PROPERTIES)
