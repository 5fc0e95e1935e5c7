"""Which armature a solve was started for, whatever is clicked while it runs."""

from typing import NamedTuple

import bpy

from ..solvers.errors import InvalidMotionError
from .redo import fingerprint


class Subject(NamedTuple):
    """A scene and an armature, by numbers: undo replaces what Blender's own pointers mean."""

    scene: int
    armature: int
    name: str
    """Of the armature, when the solve was started."""

    @classmethod
    def of(cls, scene: bpy.types.Scene, armature: bpy.types.Object) -> "Subject":
        """Remember both."""
        return cls(scene.session_uid, armature.session_uid, armature.name)

    def find(self) -> tuple[bpy.types.Scene, bpy.types.Object]:
        """Return both; raise InvalidMotionError where one was deleted meanwhile."""
        scenes = [each for each in bpy.data.scenes if each.session_uid == self.scene]
        armatures = [each for each in bpy.data.objects if each.session_uid == self.armature]
        if not (scenes and armatures):
            raise InvalidMotionError(
                f"{self.name} or its scene was deleted during the solve; nothing was written."
            )
        return scenes[0], armatures[0]


def check_unchanged(armature: bpy.types.Object, asked: str | None, present: object) -> None:
    """Raise InvalidMotionError if what was solved is not what is there now.

    Parameters
    ----------
    armature : the armature that was read
    asked : fingerprint of what was solved; None where nothing can have changed since
    present : the same, read again
    """
    if asked is not None and asked != fingerprint(present):
        raise InvalidMotionError(
            f"The action, the rig or the frame range of {armature.name} was changed during the"
            " solve; nothing was written. Press the button again."
        )
