"""Button: listen to an actor before a camera, who gives commands by gestures."""

import bpy

from ..mocap_assist.live.listen_button import ListenButton


class MOCAP_OT_listen(ListenButton, bpy.types.Operator):
    bl_idname = "mocap_assist.listen"
    bl_label = "Listen for Gestures"
    bl_description = (
        "Search by performing in front of a depth camera that streams joints; press again to"
        " stop"
    )
