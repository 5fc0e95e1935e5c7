"""Button: let a body with mass and muscles make the motion."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.physics.scene_simulating import (
    SimulateBundle,
    read_simulating,
    write_simulated,
)
from ..mocap_assist.runtime.selection import why_not_change
from ..mocap_assist.runtime.solver_operator import SolverOperator


@settings_from(SimulateBundle)
class MOCAP_OT_simulate(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.simulate"
    bl_label = "Simulate"
    bl_description = (
        "Simulate a body with mass that follows the motion on solid ground; writes a new action"
    )
    settings_group = "simulate"
    why_not, read_scene, write_scene = why_not_change, read_simulating, write_simulated

    def draw(self, context: bpy.types.Context) -> None:
        """Offer in the redo panel what needs no new simulation."""
        self.layout.use_property_split = True
        self.layout.prop(self, "strength")
