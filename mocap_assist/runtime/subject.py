"""What a solve was started for, whatever is clicked while it runs."""

from typing import NamedTuple

import bpy

from ...solvers.errors import InvalidMotionError
from ..blender.block_references import BlockReference
from .redo import fingerprint


class Subject(NamedTuple):
    """A scene, and in it an armature or what holds the markers of a take."""

    scene: BlockReference
    thing: BlockReference

    @classmethod
    def of(cls, scene: bpy.types.Scene, thing: bpy.types.Object) -> "Subject":
        """Remember both."""
        return cls(BlockReference.of(scene), BlockReference.of(thing))

    def find(self) -> tuple[bpy.types.Scene, bpy.types.Object]:
        """Return both; raise InvalidMotionError where one was deleted meanwhile."""
        return self.scene.find(), self.thing.find()


def check_unchanged(thing: bpy.types.Object, asked: str | None, present: object) -> None:
    """Raise InvalidMotionError if what was solved is not what is there now.

    Parameters
    ----------
    thing : the armature, or the holder of markers, that was read
    asked : fingerprint of what was solved; None where nothing can have changed since
    present : the same, read again
    """
    if asked is not None and asked != fingerprint(present):
        raise InvalidMotionError(
            f"The action, the rig or the frame range of {thing.name} was changed during the"
            " solve; nothing was written. Press the button again."
        )
