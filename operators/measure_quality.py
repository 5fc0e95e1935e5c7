"""Button: list what is wrong with the action that the active armature plays."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.check.button_settings import CheckBundle
from ..mocap_assist.check.renewing import CheckOperator
from ..mocap_assist.check.scene_checking import read_checking, show_checked
from ..mocap_assist.runtime.selection import why_not_read


@settings_from(CheckBundle)
class MOCAP_OT_measure_quality(CheckOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.measure_quality"
    bl_label = "Check"
    bl_description = "List jumps, jitter, gaps and foot slides of the current action"
    # It only makes a list: nothing to undo, and no redo panel, which would solve again.
    bl_options: ClassVar = {"REGISTER"}
    settings_group = "check"
    why_not, read_scene, write_scene = why_not_read, read_checking, show_checked
