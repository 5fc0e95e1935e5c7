"""Button: fix a take of any origin with the steps that suit it."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.fix.button_settings import FixBundle
from ..mocap_assist.fix.scene_fixing import (
    read_fixing,
    selected_take,
    watch_fixing,
    why_not_fix,
    write_fixed,
)
from ..mocap_assist.runtime.watched_operator import WatchedOperator


@settings_from(FixBundle)
class MOCAP_OT_fix_take(WatchedOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.fix_take"
    bl_label = "Fix My Take"
    bl_description = (
        "Track, clean, solve or reconstruct the take, whatever its origin; writes a new action"
    )
    settings_group = "fix"
    selected, why_not = selected_take, why_not_fix
    read_scene, write_scene, open_view = read_fixing, write_fixed, watch_fixing

    def draw(self, context: bpy.types.Context) -> None:
        """Offer nothing in the redo panel: every change there would solve again."""
