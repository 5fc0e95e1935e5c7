"""Button: track the actor whom a depth camera recorded."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.runtime.watched_operator import WatchedOperator
from ..mocap_assist.track.tracking import (
    TrackBundle,
    read_tracking,
    rescue_partial,
    selected_preview,
    watch_tracking,
    why_not_track,
    write_tracked,
)


@settings_from(TrackBundle)
class MOCAP_OT_track_depth(WatchedOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.track_depth"
    bl_label = "Track"
    bl_description = (
        "Find the actor in a depth recording and track the body; creates an animated armature"
    )
    settings_group = "track"
    selected, why_not = selected_preview, why_not_track
    read_scene, write_scene = read_tracking, write_tracked
    open_view, rescue = watch_tracking, rescue_partial

    def draw(self, context: bpy.types.Context) -> None:
        """Draw nothing: no setting can change without tracking again."""
