"""Keys of a variant in the channels of its armature's bones."""

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.motion import Motion
from ..actions.bone_channels import animated_curves
from ..actions.curves import CONSTANT, deselect, write_first
from ..actions.take import ArmatureTake, TakePart, basis_rotations, root_locations
from ..actions.unchanged_samples import MIN_CHANGE
from ..blender import compat
from ..blender.compat import Source
from ..scene.controls import BoneKeys
from ..scene.rig import Placement

BONE = re.compile(r'pose\.bones\["(.+?)"\]')


class Held(NamedTuple):
    """A channel that no variant changes, and its value at the example's first frame."""

    path: str
    array_index: int
    group: str
    value: float


class BaseExample(NamedTuple):
    """The first example; it supplies every channel except the body's motion."""

    take: ArmatureTake
    rotated: frozenset[int]
    """Bones with keyed rotations in any example."""
    held: tuple[Held, ...]

    @classmethod
    def of(
        cls, takes: Sequence[ArmatureTake], first: Source, movers: Collection[str] = ()
    ) -> "BaseExample":
        """Take it from the examples, but for the channels of some bones."""
        rotated = {
            index
            for take in takes
            for index, each in enumerate(take.channels)
            if each.rotation_keyed
        }
        start = takes[0].frames[:1]
        held = tuple(
            Held(path, index, _group(channel.curve), float(channel.values(start)[0]))
            for (path, index), channel in animated_curves(*first).items()
            if channel.is_on and not _is_of_movers(path, movers)
        )
        return cls(takes[0], frozenset(rotated), held)

    def frames(self, n_frames: int) -> Array:
        """Return scene frames from the example's first, with its step or integer ones."""
        grid = self.take.grid
        return np.asarray(grid.frames[0] + max(grid.step, 1.0) * np.arange(n_frames))

    def keys(self, motion: Motion) -> Mapping[str, BoneKeys]:
        """Return the channels of the bones for a motion of the body."""
        rig, body = self.take.rig, self.take.parts[0]
        carrier = Placement(
            body.carrier.rotations[:1], body.carrier.origins[:1], body.carrier.scale
        )
        part = TakePart(motion, body.bones, carrier)
        rotations_by_bone = basis_rotations(part, rig, self.take.rest)
        root = body.bones[0]
        return {
            rig.bones[bone]: BoneKeys(
                _once_if_still(rotations_by_bone[bone]),
                root_locations(part, rig) if bone == root else None,
            )
            for bone in rotations_by_bone
            if bone in self.rotated or bone == root
        }


def without_still(keys: Mapping[str, BoneKeys]) -> Mapping[str, BoneKeys]:
    """Return channels; bones that never rotate have their first key only."""
    return {
        bone: replace(each, rotations=_once_if_still(each.rotations))
        if each.rotations is not None and np.isfinite(each.rotations).all()
        else each
        for bone, each in keys.items()
    }


def _is_of_movers(path: str, movers: Collection[str]) -> bool:
    """Whether a channel is of one of these bones."""
    named = BONE.match(path)
    return named is not None and named[1] in movers


def _once_if_still(rotations: Array) -> Array:
    """Return rotations, (n_frames, 4), or only the first one if they are constant."""
    if np.abs(rotations - rotations[:1]).max() > MIN_CHANGE:
        return rotations
    first_only = np.full_like(rotations, np.nan)
    first_only[0] = rotations[0]
    return first_only


def hold_others(
    action: bpy.types.Action, slot: bpy.types.ActionSlot, stage: BaseExample
) -> None:
    """Add one key for each channel of the example that the action lacks."""
    bag = compat.ensure_channelbag(action, slot)
    there = {curve.data_path for curve in bag.fcurves}
    start = stage.take.frames[:1]
    for path, index, group, value in stage.held:
        if path not in there:
            curve = compat.new_curve(bag, path, index, group)
            write_first(curve, start, np.array([value]), interpolation=CONSTANT)
            deselect(curve)


def _group(curve: bpy.types.FCurve) -> str:
    return str(curve.group.name) if curve.group is not None else "Object"
