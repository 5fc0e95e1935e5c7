"""Button: list the clips of the library that are like the action."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.find_similar.scene_finding import list_found, read_finding, why_not_find
from ..mocap_assist.library.button_settings import FindBundle
from ..mocap_assist.runtime.solver_operator import SolverOperator


@settings_from(FindBundle)
class MOCAP_OT_find_similar(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.find_similar"
    bl_label = "Find Similar"
    bl_description = (
        "List the library clips most similar to this motion, and the frames that match"
    )
    bl_options: ClassVar = set[str]()  # the list is no part of the file

    settings_group = "find"
    why_not = why_not_find
    read_scene = read_finding
    write_scene = list_found
