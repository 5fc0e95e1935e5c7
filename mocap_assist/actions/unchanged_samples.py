"""Keep the recorded values of the samples that a result does not change."""

from typing import NamedTuple

import bpy
import numpy as np

from ...solvers.arrays import Array, Flags
from ...solvers.rotations import angle_between
from ..blender.compat import Source
from .bone_channels import (
    animated_curves,
    location_curves,
    rotation_curves,
    sampled,
    sampled_rotation,
)
from .take import ArmatureTake

MIN_CHANGE = 1e-6
"""Radians or meters below which two samples are the same. It bounds the rounding of a rotation
that became a quaternion and angles again; keys of 32 bits resolve 1e-7 at one unit."""


class RecordedChannels(NamedTuple):
    """A recorded action, and the take that was read from it."""

    take: ArmatureTake
    source: Source


class UnchangedSamples:
    """The samples of a result that are those of the recording."""

    def __init__(self, recorded: RecordedChannels, result: ArmatureTake) -> None:
        self._take, self._source = recorded
        self._curves = animated_curves(*recorded.source)
        self._rotations = recorded.take.bone_rotations(), result.bone_rotations()
        self._locations = recorded.take.bone_locations(), result.bone_locations()

    def rotations(self, bone: bpy.types.PoseBone, index: int, values: Array) -> Array:
        """Return rotation channels of a bone, with recorded values where nothing changed."""
        before, after = (each[index] for each in self._rotations)
        channels = rotation_curves(bone, self._curves)
        recorded = sampled_rotation(bone, channels, self._take.frames)
        return _restored(values, recorded, np.abs(angle_between(before, after)) < MIN_CHANGE)

    def locations(self, bone: bpy.types.PoseBone, index: int, values: Array) -> Array:
        """Return location channels of a bone, with recorded values where nothing changed."""
        before, after = (each[index] for each in self._locations)
        recorded = sampled(
            location_curves(bone, self._curves), bone.location, self._take.frames
        )
        return _restored(values, recorded, (np.abs(after - before) < MIN_CHANGE).all(axis=1))


def _restored(values: Array, recorded: Array, same: Flags) -> Array:
    """Return the recorded values where the pose is the same.

    A rotation has many angles. Next to samples that did change, only those are recorded ones
    that would not rotate the bone by a full turn in between.
    """
    if not same.all():
        same = same & (np.abs(values - recorded) < MIN_CHANGE).all(axis=1)
    return np.where(same[:, None], recorded, values)
