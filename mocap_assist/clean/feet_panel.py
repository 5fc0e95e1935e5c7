"""Panel: contacts of feet, hands, knees and hips as editable keys."""

from typing import ClassVar

import bpy

from ..actions.contact_keys import FOOT_PROPERTIES, PROPERTIES
from ..blender.mixins import PanelMixin
from ..overlays.contacts.switch import draw_contact_switch
from ..panel_parts.panel_layout import draw_sentence, operator_exists
from ..panel_parts.visibility import shows_armature
from ..runtime.selection import selected_armature

PLANT = "mocap_assist.plant_feet"
LABELS = (
    "Left Foot Contact",
    "Right Foot Contact",
    "Left Hand Contact",
    "Right Hand Contact",
    "Left Knee Contact",
    "Right Knee Contact",
    "Hips Contact",
)
HINT = "Key 1 while it bears on the floor, 0 while it moves, then press Plant Feet."


class FeetPanel(PanelMixin):
    """The keyed contacts, and the button that plants the body by them."""

    bl_label = "Feet"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return operator_exists(PLANT) and shows_armature(context)

    def draw(self, context: bpy.types.Context) -> None:
        layout, armature = self.layout, selected_armature(context)
        if armature is not None and all(name in armature for name in FOOT_PROPERTIES):
            column = layout.column(align=True)
            for name, text in zip(PROPERTIES, LABELS, strict=True):
                if name in armature:
                    column.prop(armature, f'["{name}"]', text=text)
            draw_sentence(layout, context, HINT)
            draw_contact_switch(layout, context)
        layout.operator(PLANT, icon="CON_FLOOR")
