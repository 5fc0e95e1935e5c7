"""The subject of a solve, independent of later clicks."""

from functools import partial
from typing import NamedTuple

import bpy

from ..blender.block_references import BlockReference, changed_during_solve
from ..blender.time_slices import Sliced, Steps, in_thread
from .redo import fingerprint


class Subject(NamedTuple):
    """A scene, and an armature or the parent of a take's markers in it."""

    scene: BlockReference
    target: BlockReference

    @classmethod
    def of(cls, scene: bpy.types.Scene, target: bpy.types.Object) -> "Subject":
        """Return references to both."""
        return cls(BlockReference.of(scene), BlockReference.of(target))

    def find(self) -> tuple[bpy.types.Scene, bpy.types.Object]:
        """Return both; raise InvalidMotionError if one was deleted meanwhile."""
        return self.scene.find(), self.target.find()


@Sliced
def check_unchanged(
    target: bpy.types.Object, solved_digest: str | None, current: object
) -> Steps[None]:
    """Raise InvalidMotionError if the scene no longer holds the problem that was solved.

    Parameters
    ----------
    target : the armature, or the parent of markers, that was read
    solved_digest : fingerprint of the solved problem; None if it cannot have changed since
    current : the same problem, read again
    """
    if solved_digest is None:
        return
    name = target.name
    if solved_digest != (yield from in_thread.steps(partial(fingerprint, current))):
        raise changed_during_solve(name)
