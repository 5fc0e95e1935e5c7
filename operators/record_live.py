"""Button: let a rig follow the actor before a camera, and record the motion."""

import bpy

from ..mocap_assist.blender.last_press import note_press
from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.languages import translated
from ..mocap_assist.live.live_take import (
    ESC_ENDS,
    LOOK_INTERVAL_S,
    NO_DURATION,
    LiveBundle,
    keep_on_esc,
    read_live,
    watch_live,
    why_not_record,
    write_live,
)
from ..mocap_assist.runtime.selection import selected_armature
from ..mocap_assist.runtime.watched_operator import WatchedOperator


@settings_from(LiveBundle)
class MOCAP_OT_record_live(WatchedOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.record_live"
    bl_label = "Record Live"
    bl_description = (
        "Let the armature follow the joints that a tracker streams, and record them; Esc ends"
    )
    settings_group = "live"
    look_interval_s = LOOK_INTERVAL_S
    selected, why_not = selected_armature, why_not_record
    read_scene, write_scene = read_live, write_live
    open_view, rescue = watch_live, keep_on_esc

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not self.duration:  # nothing would end it
            self.report({"ERROR"}, translated(NO_DURATION))
            note_press(self, sentence=NO_DURATION)
            return {"CANCELLED"}
        return super().execute(context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        outcome = super().invoke(context, event)
        if outcome == {"RUNNING_MODAL"}:
            self._watch.ending = ESC_ENDS
        return outcome

    def draw(self, context: bpy.types.Context) -> None:
        """Draw nothing: a recording cannot be made again with other settings."""
