"""Button: set the frames to work on by a drag on the strip."""

import bpy

from ..mocap_assist.overlays.strip.drag import RangeOperator


class MOCAP_OT_set_range(RangeOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.set_range"
    bl_label = "Set Frame Range"
    bl_description = "Drag on the strip to clean only these frames; click it for all frames"

    start: bpy.props.IntProperty(
        name="Start", description="First frame", default=1, options={"SKIP_SAVE"}
    )
    end: bpy.props.IntProperty(
        name="End",
        description="Last frame; one before the start clears the range",
        options={"SKIP_SAVE"},
    )
