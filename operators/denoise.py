"""Button: take jitter, spikes and gaps out of the action of an armature or of markers."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.clean.button_settings import FINISHING_SETTINGS, CleanBundle
from ..mocap_assist.clean.scene_cleaning import read_cleaning, write_cleaned
from ..mocap_assist.runtime.selection import why_not_clean
from ..mocap_assist.runtime.solver_operator import SolverOperator


@settings_from(CleanBundle)
class MOCAP_OT_denoise(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.denoise"
    bl_label = "Clean"
    bl_description = (
        "Remove jitter and spikes, fill gaps and plant the feet; writes a new action"
    )

    settings_group = "clean"
    why_not, read_scene, write_scene = why_not_clean, read_cleaning, write_cleaned

    def draw(self, context: bpy.types.Context) -> None:
        """Offer only settings without a new solve in the redo panel; a solve would block."""
        self.layout.use_property_split = True
        for name in FINISHING_SETTINGS:
            self.layout.prop(self, name)
