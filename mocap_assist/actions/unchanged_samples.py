"""Keep the recorded values of the samples that a result does not change."""

from typing import NamedTuple

import bpy
import numpy as np

from ...solvers.arrays import Array, Flags
from ...solvers.rotations import angle_between
from ..blender.block_references import SourceReference
from .bone_channels import (
    animated_curves,
    location_curves,
    rotation_curves,
    sampled,
    sampled_rotation,
)
from .take import ArmatureTake, BonePoses

MIN_CHANGE = 1e-6
"""Radians or meters below which two samples are the same. It bounds the rounding of a rotation
that became a quaternion and angles again; keys of 32 bits resolve 1e-7 at one unit."""


class RecordedChannels(NamedTuple):
    """A recorded action, and the take that was read from it."""

    take: ArmatureTake
    source: SourceReference


class UnchangedSamples:
    """The samples of a result that are those of the recording."""

    def __init__(self, recorded: RecordedChannels, before: BonePoses, after: BonePoses) -> None:
        """`before` are the poses of the recorded take, `after` those of the result."""
        self._frames, self._before, self._after = recorded.take.frames, before, after
        self._source = recorded.source
        self.find_again()

    def find_again(self) -> None:
        """Look up the recorded curves again: pointers are stale after a time slice."""
        self._curves = animated_curves(*self._source.find())

    def rotations(self, bone: bpy.types.PoseBone, index: int, values: Array) -> Array:
        """Return rotation channels of a bone, with recorded values where nothing changed."""
        before, after = self._before.rotations[index], self._after.rotations[index]
        channels = rotation_curves(bone, self._curves)
        recorded = sampled_rotation(bone, channels, self._frames)
        return _restore_recorded(
            values, recorded, np.abs(angle_between(before, after)) < MIN_CHANGE
        )

    def locations(self, bone: bpy.types.PoseBone, index: int, values: Array) -> Array:
        """Return location channels of a bone, with recorded values where nothing changed."""
        before, after = self._before.locations[index], self._after.locations[index]
        recorded = sampled(location_curves(bone, self._curves), bone.location, self._frames)
        return _restore_recorded(
            values, recorded, (np.abs(after - before) < MIN_CHANGE).all(axis=1)
        )


def _restore_recorded(values: Array, recorded: Array, same: Flags) -> Array:
    """Return the recorded values where the pose is the same.

    A rotation has many angles. Next to samples that did change, only those are recorded ones
    that would not rotate the bone by a full turn in between.
    """
    if not same.all():
        same = same & (np.abs(values - recorded) < MIN_CHANGE).all(axis=1)
    return np.where(same[:, None], recorded, values)
