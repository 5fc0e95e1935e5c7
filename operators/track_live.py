"""Button: track an actor while a depth camera records."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.track.follow_button import FollowButton
from ..mocap_assist.track.following import FollowBundle


@settings_from(FollowBundle)
class MOCAP_OT_track_live(FollowButton, bpy.types.Operator):
    bl_idname = "mocap_assist.track_live"
    bl_label = "Track Live"
    bl_description = (
        "Track the actor while a depth camera records; Esc ends and creates an armature"
    )
