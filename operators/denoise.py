"""Button: take jitter, spikes and gaps out of the active armature's action."""

from collections.abc import Callable

import bpy

from ..mocap_assist.cleaning import (
    CleanChoices,
    read_cleaning,
    selected_armature,
    write_cleaned,
)
from ..mocap_assist.jobs.cleaning import Cleaned
from ..mocap_assist.settings_properties import settings_from
from ..mocap_assist.solver_operator import SolverOperator
from ..solvers.denoising import DenoiseSettings


@settings_from(CleanChoices, DenoiseSettings)
class MOCAP_OT_denoise(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.denoise"
    bl_label = "Clean"
    bl_description = (
        "Take jitter, spikes and gaps out of the armature's action. The result is a new action;"
        " the recorded one stays as it is"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = selected_armature(context)
        if armature is None:
            cls.poll_message_set("Select an armature that plays a captured action")
            return False
        return True

    def read(self, context: bpy.types.Context) -> Callable[..., Cleaned]:
        settings = self.settings_of(DenoiseSettings)
        return read_cleaning(context, self.settings_of(CleanChoices), settings)

    def write(self, context: bpy.types.Context, result: Cleaned) -> str:
        choices, settings = self.settings_of(CleanChoices), self.settings_of(DenoiseSettings)
        return write_cleaned(context, choices, settings, result)
