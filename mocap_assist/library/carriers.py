"""Objects that carry an armature: in files of other programs they may hold a part of the
motion."""

from collections.abc import Iterator
from dataclasses import replace

import bpy
import numpy as np
from mathutils import Matrix

from ...solvers.arrays import Array
from ...solvers.errors import InvalidMotionError
from ...solvers.motion import Motion
from ...solvers.rotations import multiply, rotate
from ..actions.fitting import fitting_slots
from ..blender import compat
from ..blender.compat import Source
from ..scene.rig import placement_of

MAX_GROWTH = 0.01
"""Change of size, a ratio, of a carrier that is only rounding. Chosen by hand: a body of 1.75 m
changes by less than 2 cm."""


def with_carriers(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    source: Source,
    frames: Array,
    motion: Motion,
    unit: float,
) -> Motion:
    """Return a take with the motion of the objects above its armature, and of its constraints.

    Parameters
    ----------
    scene : bpy.types.Scene
    armature : bpy.types.Object
    source : Source
        Action and slot of the take; the carriers play theirs of the same take.
    frames : shape (n_frames,)
        Frames of the scene at which the take was read.
    motion : Motion
        Read as if the carriers stayed where they are at the current frame.
    unit : float
        Meters of the motion per unit of the scene.

    Raises
    ------
    InvalidMotionError
        A carrier changes its size, or its scale differs between axes.
    """
    carriers = [each for each in _objects_above(armature) if _is_moving(each)]
    if not carriers and not armature.constraints:
        return motion
    before = scene.frame_current
    start = _carried_by(armature).inverted()
    for carrier in carriers:
        _play(carrier, armature, source)
    moves = []
    try:
        for frame in frames:
            scene.frame_set(int(np.floor(frame)), subframe=float(frame - np.floor(frame)))
            moves.append(placement_of(_carried_by(armature) @ start, armature.name))
    finally:
        scene.frame_set(before)
    if np.ptp([size for _, _, size in moves]) > MAX_GROWTH:
        raise InvalidMotionError(
            f"The objects above {armature.name} change their size. Bake them into its bones."
        )
    carrier_rotations = np.stack([rotation for rotation, _, _ in moves])
    shifts = unit * np.stack([shift for _, shift, _ in moves])
    rotations = motion.rotations.copy()
    rotations[:, 0] = multiply(carrier_rotations, rotations[:, 0])
    positions = rotate(carrier_rotations, motion.root_positions) + shifts
    return replace(motion, rotations=rotations, root_positions=positions)


def _objects_above(armature: bpy.types.Object) -> Iterator[bpy.types.Object]:
    carrier = armature.parent
    while carrier is not None:
        yield carrier
        carrier = carrier.parent


def _is_moving(carrier: bpy.types.Object) -> bool:
    return bool(carrier.constraints) or carrier.animation_data is not None


def _carried_by(armature: bpy.types.Object) -> Matrix:
    """Return the transform that the armature's own location and rotation are relative to."""
    shown = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return shown.matrix_world @ shown.matrix_basis.inverted()


def _play(carrier: bpy.types.Object, armature: bpy.types.Object, source: Source) -> None:
    """Let a carrier play its part of a take; without one it stays where it is.

    Where the armature has no other take, what the carrier plays is of this one.
    """
    part = _part_of(carrier, armature, source[0])
    n_takes = sum(bool(fitting_slots(armature, action)) for action in bpy.data.actions)
    if part is None and n_takes == 1:
        return
    carrier.animation_data_create().action = None
    for track in _tracks(carrier):
        track.mute = True
    if part is not None:
        compat.assign(carrier, *part)


def _part_of(
    carrier: bpy.types.Object, armature: bpy.types.Object, action: bpy.types.Action
) -> Source | None:
    """Return the carrier's slot of an action, or the action with the name of the armature's
    take."""
    own = next((slot for slot in action.slots if slot.identifier == f"OB{carrier.name}"), None)
    if own is not None:
        return action, own
    names = {
        track.name
        for track in _tracks(armature)
        if any(strip.action == action for strip in track.strips)
    }
    for track in _tracks(carrier):
        if track.name in names and track.strips:
            strip = track.strips[0]
            return strip.action, strip.action_slot
    _, bar, stack = action.name.partition("|")  # Blender's older importer of FBX
    part = bpy.data.actions.get(f"{carrier.name}|{stack}") if bar else None
    return (part, part.slots[0]) if part and part.slots else None


def _tracks(owner: bpy.types.Object) -> list[bpy.types.NlaTrack]:
    return list(owner.animation_data.nla_tracks) if owner.animation_data else []
