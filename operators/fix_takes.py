"""Button: fix all selected takes, or those of a folder, one after another."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.fix.button_settings import FixBundle
from ..mocap_assist.fix.queue_operator import QueueOperator, always
from ..mocap_assist.fix.scene_fixing import read_fixing, watch_fixing, write_fixed


@settings_from(FixBundle)
class MOCAP_OT_fix_takes(QueueOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.fix_takes"
    bl_label = "Fix Selected Takes"
    bl_description = "Fix each selected take in turn; each result is an undo step of its own"
    settings_group = "fix"
    read_scene, write_scene, open_view = read_fixing, write_fixed, watch_fixing
    why_not = always

    def draw(self, context: bpy.types.Context) -> None:
        """Offer nothing in the redo panel: every change there would solve again."""
