"""Button: let Clean or Reconstruct learn from the best matches."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.find_similar.examples_from_matches import (
    CLEAN,
    RECONSTRUCT,
    learn_from_best,
)
from ..mocap_assist.find_similar.searches import why_none


class MOCAP_OT_learn_from_matches(ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.learn_from_matches"
    bl_label = "Learn from Matches"
    bl_description = "Replace the list of examples with the best of these clips"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    why_not = why_none

    group: bpy.props.EnumProperty(
        name="For",
        description="Button that learns from the examples",
        items=[
            (CLEAN, "Clean", "Use the clips as examples of Clean"),
            (RECONSTRUCT, "Reconstruct", "Use the clips as examples of Reconstruct"),
        ],
        options={"SKIP_SAVE"},
    )
    n_best: bpy.props.IntProperty(
        name="Clips",
        description="Number of best matches to use; more adds less similar clips",
        default=5,
        min=1,
        max=48,
        options={"SKIP_SAVE"},
    )

    def act(self, context: bpy.types.Context) -> str:
        return learn_from_best(context, self.group, self.n_best)
