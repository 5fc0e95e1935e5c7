"""Button: choose a folder whose takes the workers of a render farm fix."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.farm.button_settings import FarmBundle
from ..mocap_assist.farm.submit_operator import FarmOperator
from ..mocap_assist.farm.submitting import read_submission, report_submitted, why_not_submit


@settings_from(FarmBundle)
class MOCAP_OT_submit_folder(FarmOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.submit_folder"
    bl_label = "Submit Folder"
    bl_description = (
        "Submit a job to Flamenco that fixes the takes of a folder, but for FBX, glTF and USD"
    )
    settings_group = "fix"
    why_not, read_scene, write_scene = why_not_submit, read_submission, report_submitted
