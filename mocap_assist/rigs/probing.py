"""Find out what carries each control of a rig, by moving a copy of it."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager

import bpy
import numpy as np
from mathutils import Euler, Matrix

from ...solvers.arrays import Array

N_POSES = 3
"""Number of random poses in which controls are compared. It bounds the run time; with one, two
controls may agree by chance."""
MAX_ROTATION_RAD = 0.35
"""Largest angle of a random rotation, radians. Chosen by hand: 20 degrees."""
MAX_SHIFT_FRACTION = 0.03
"""Largest random displacement, relative to the rig's height. Chosen by hand: 5 cm of a rig of
1.8 m."""
MAX_DIFFERENCE = 2e-3
"""Difference between controls that move together, a ratio: of entries of rotation matrices, and
of positions relative to the rig's height. Chosen by hand: 0.1 degrees, of rotations of up to
20, and 4 mm of a rig of 1.8 m."""
Switches = Mapping[tuple[str, str], float]


def find_carriers(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    controls: Sequence[tuple[str, bool]],
    switches: Switches,
) -> dict[str, str | None]:
    """Return for each control the one that it moves along with.

    Parameters
    ----------
    scene : bpy.types.Scene
    armature : bpy.types.Object
        Not touched: a copy is posed.
    controls : names of bones, and whether their location is keyed too
    switches : values of custom properties of bones while they are keyed

    Returns
    -------
    dict of bone to bone, or to "" for what nothing carries, or None where it is none of them
    """
    names = [name for name, _ in controls]
    movers = [name for name, moves in controls if moves]
    with _posable_copy(scene, armature, switches) as (copy, depsgraph):
        height = max(max(bone.tail_local.length for bone in copy.data.bones), 1e-9)
        probes = [
            _carried_and_moved(scene, copy, depsgraph, names, movers, seed, height)
            for seed in range(N_POSES)
        ]
    carried = {name: np.stack([space[name] for space, _ in probes]) for name in names}
    moved = {name: np.stack([delta[name] for _, delta in probes]) for name in names}
    moved[""] = np.tile(np.eye(4), (N_POSES, 1, 1))
    return {
        name: _movers_in_common(
            carried[name], moved, name, height if name in movers else np.inf
        )
        for name in names
    }


def _movers_in_common(
    carried: Array, moved: Mapping[str, Array], name: str, height: float
) -> str | None:
    """Return which controls move together; positions count only if the height is finite."""
    for other, movement in moved.items():
        difference = np.abs(carried - movement)
        if (
            other != name
            and difference[:, :3, :3].max() < MAX_DIFFERENCE
            and difference[:, :3, 3].max() < MAX_DIFFERENCE * height
        ):
            return other
    return None


@contextmanager
def _posable_copy(
    scene: bpy.types.Scene, armature: bpy.types.Object, switches: Switches
) -> Iterator[tuple[bpy.types.Object, bpy.types.Depsgraph]]:
    copy = armature.copy()
    layer = scene.view_layers[0]
    try:
        if copy.animation_data is not None:
            copy.animation_data.action = None
            for track in copy.animation_data.nla_tracks:
                track.mute = True
        copy.hide_viewport = False
        scene.collection.objects.link(copy)
        for bone in copy.pose.bones:
            bone.matrix_basis = Matrix()
            for constraint in bone.constraints:
                if constraint.type == "LIMIT_ROTATION":  # it would cut the probes short
                    constraint.mute = True
        for (bone, name), value in switches.items():
            if bone in copy.pose.bones and name in copy.pose.bones[bone]:
                present = copy.pose.bones[bone][name]
                copy.pose.bones[bone][name] = type(present)(value)
        layer.update()
        yield copy, layer.depsgraph
    finally:
        bpy.data.objects.remove(copy)


def _carried_and_moved(
    scene: bpy.types.Scene,
    copy: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    names: Sequence[str],
    movers: Collection[str],
    seed: int,
    height: float,
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Return how far each control's carrier and the control itself moved from rest."""
    rng = np.random.default_rng(seed)
    for name in names:
        rotation = (
            Euler(rng.uniform(-MAX_ROTATION_RAD, MAX_ROTATION_RAD, 3)).to_matrix().to_4x4()
        )
        if name in movers:
            rotation.translation = rng.uniform(-1.0, 1.0, 3) * MAX_SHIFT_FRACTION * height
        copy.pose.bones[name].matrix_basis = rotation
    scene.view_layers[0].update()
    posed = copy.evaluated_get(depsgraph).pose.bones
    carried, moved = {}, {}
    for name in names:
        bone = posed[name]
        back = bone.bone.matrix_local.inverted()
        rotation = bone.matrix_basis.to_3x3().to_4x4()
        shift = location_axes(bone.bone) @ bone.location
        moved[name] = np.array(bone.matrix @ back)
        space = bone.matrix @ rotation.inverted() @ back @ Matrix.Translation(-shift)
        carried[name] = np.array(space)
    return carried, moved


def location_axes(bone: bpy.types.Bone) -> Matrix:
    """Return the axes along which a bone's location shifts it, in the rest pose."""
    if bone.use_local_location:
        return bone.matrix_local.to_3x3()
    return bone.parent.matrix_local.to_3x3() if bone.parent else Matrix.Identity(3)
