"""Button: track again from a frame that was corrected by hand."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.runtime.selection import selected_armature
from ..mocap_assist.runtime.watched_operator import WatchedOperator
from ..mocap_assist.track.retracking import (
    RetrackBundle,
    read_retracking,
    watch_retracking,
    why_not_retrack,
    write_retracked,
)


@settings_from(RetrackBundle)
class MOCAP_OT_retrack(WatchedOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.retrack"
    bl_label = "Track from Here"
    bl_description = (
        "Re-track from the corrected pose at the current frame; writes a new action"
    )
    settings_group = "retrack"
    selected, why_not = selected_armature, why_not_retrack
    read_scene, write_scene = read_retracking, write_retracked
    open_view = watch_retracking

    def draw(self, context: bpy.types.Context) -> None:
        """Nothing can be changed without tracking again."""
