"""Button: bring the clip library up to date."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.library.choices import LibraryBundle
from ..mocap_assist.library.index_operator import WaitingIndex


@settings_from(LibraryBundle)
class MOCAP_OT_index_library(WaitingIndex, bpy.types.Operator):
    bl_idname = "mocap_assist.index_library"
    bl_label = "Index"
    bl_description = (
        "Read the clips of these folders, files and asset libraries into the library, beside"
        " your work. What has not changed since is passed over"
    )
    bl_options: ClassVar = set[str]()  # nothing of the file is changed
