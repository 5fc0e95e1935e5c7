"""Button: rebuild clean poses from what a depth camera's tracker saw."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.reconstruct.button_settings import FINISHING_SETTINGS, ReconstructBundle
from ..mocap_assist.reconstruct.scene_reconstructing import (
    read_reconstructing,
    why_not_reconstruct,
    write_reconstructed,
)
from ..mocap_assist.runtime.solver_operator import SolverOperator


@settings_from(ReconstructBundle)
class MOCAP_OT_reconstruct(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.reconstruct"
    bl_label = "Reconstruct"
    bl_description = (
        "Rebuild the missing and wrong joints of a depth camera take; writes a new action"
    )
    settings_group = "reconstruct"
    why_not, read_scene, write_scene = (
        why_not_reconstruct, read_reconstructing, write_reconstructed,
    )  # fmt: skip

    def draw(self, context: bpy.types.Context) -> None:
        """Offer only settings without a new solve in the redo panel; a solve would block."""
        self.layout.use_property_split = True
        for name in FINISHING_SETTINGS:
            self.layout.prop(self, name)
