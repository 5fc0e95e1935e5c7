"""Preserve an unkeyed pose through changes of the frame."""

import bpy
import numpy as np

POSE_TOLERANCE = 1e-6
"""Entries of a pose matrix, a ratio or meters, that are only rounding."""


class HandPose:
    """The pose of an armature at construction."""

    def __init__(self, armature: bpy.types.Object) -> None:
        self._armature = armature.session_uid
        self._bones = {bone.name: bone.matrix_basis.copy() for bone in armature.pose.bones}

    def restore(self) -> None:
        """Restore the pose if the armature still exists and its pose has changed."""
        armatures = [each for each in bpy.data.objects if each.session_uid == self._armature]
        for bone in armatures[0].pose.bones if armatures else ():
            basis = self._bones.get(bone.name)
            if basis is not None and not np.allclose(
                basis, bone.matrix_basis, atol=POSE_TOLERANCE
            ):
                bone.matrix_basis = basis
