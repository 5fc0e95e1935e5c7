"""What a hand has posed and not yet keyed, through changes of the frame."""

import bpy
import numpy as np

SAME = 1e-6


class HandPose:
    """The pose of an armature when this is made."""

    def __init__(self, armature: bpy.types.Object) -> None:
        self._armature = armature.session_uid
        self._bones = {bone.name: bone.matrix_basis.copy() for bone in armature.pose.bones}

    def restore(self) -> None:
        """Pose the armature so again, where it is still there and is posed in another way."""
        found = [each for each in bpy.data.objects if each.session_uid == self._armature]
        for bone in found[0].pose.bones if found else ():
            basis = self._bones.get(bone.name)
            if basis is not None and not np.allclose(basis, bone.matrix_basis, atol=SAME):
                bone.matrix_basis = basis
