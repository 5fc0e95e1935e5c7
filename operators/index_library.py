"""Button: bring the clip library up to date."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.library.button_settings import LibraryBundle
from ..mocap_assist.library.index_operator import WaitingIndex


@settings_from(LibraryBundle)
class MOCAP_OT_index_library(WaitingIndex, bpy.types.Operator):
    bl_idname = "mocap_assist.index_library"
    bl_label = "Build Library"
    bl_description = (
        "Read the clips of these sources into the library in the background; skips unchanged"
        " ones"
    )
    bl_options: ClassVar = set[str]()  # nothing of the file is changed
