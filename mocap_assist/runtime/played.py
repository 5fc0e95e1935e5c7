"""An armature and the action that it plays, from the reading to the writing of a solve."""

from typing import NamedTuple

import bpy

from ..blender.block_references import SourceReference, changed_during_solve
from ..blender.compat import Source
from .selection import played_source
from .subject import Subject


class Played(NamedTuple):
    """References that stay valid over time slices."""

    here: Subject
    source: SourceReference

    @classmethod
    def of(cls, scene: bpy.types.Scene, armature: bpy.types.Object) -> "Played":
        """Return references to what an armature plays now."""
        return cls(Subject.of(scene, armature), SourceReference.of(played_source(armature)))

    def find(self) -> tuple[bpy.types.Scene, bpy.types.Object, Source]:
        """Return scene, armature, and what it plays.

        Raises InvalidMotionError if one was deleted, or the armature plays something else.
        """
        scene, armature = self.here.find()
        source = played_source(armature)
        if not self.source.is_same(source):
            raise changed_during_solve(armature.name)
        return scene, armature, source
