"""Button: listen to an actor before a camera, who gives commands by gestures."""

import bpy

from ..mocap_assist.live.listen_button import ListenButton


class MOCAP_OT_listen(ListenButton, bpy.types.Operator):
    bl_idname = "mocap_assist.listen"
    bl_label = "Listen"
    bl_description = (
        "Listen to a live stream of joints on this machine: an actor before a depth camera"
        " searches by performing. Press again, or Esc, to stop"
    )
