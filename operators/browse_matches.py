"""Button: show the matches over the 3D View; the one under the pointer plays."""

import bpy

from ..mocap_assist.find_similar.gallery_operator import BrowseOperator


class MOCAP_OT_browse_matches(BrowseOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.browse_matches"
    bl_label = "Play Matches"
    bl_description = "Show the matches over the 3D View; the one under the pointer plays"
