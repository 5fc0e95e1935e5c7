"""Write a recording into a new action: a key for each frame that was observed, no others."""

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.motion import Motion
from ...solvers.progress import Progress, unwatched
from ...solvers.rotations import IDENTITY
from ..blender import compat
from ..blender.compat import Source
from ..scene.rig import Placement, read_rig
from .bone_channels import bone_path
from .curves import write_first
from .rotation_modes import channels_from_quaternions, rotation_property
from .take import TakePart, basis_rotations, root_locations


def write_motion(
    armature: bpy.types.Object,
    bones: tuple[str, ...],
    motion: Motion,
    frames: Array,
    meters: float,
    *,
    name: str = "",
    progress: Progress = unwatched,
) -> Source:
    """Assign a new action with the motion to an armature.

    Parameters
    ----------
    armature : made by `build_armature`, standing at the world's origin
    bones : name of each joint's bone, or nothing
    motion : Motion
        Where it was not observed there are no keys. A joint that never turns has none at all.
    frames : shape (n_frames,), scene frames
    meters : length of one of the scene's units
    name : of the action; by default that of the armature
    progress : Progress

    Returns
    -------
    action, slot
    """
    action, slot = compat.new_action(name or armature.name, armature)
    bag = compat.ensure_channelbag(action, slot)
    rig = read_rig(armature)
    owners = tuple(rig.bones.index(bone) if bone else -1 for bone in bones)
    n_frames = motion.n_frames
    world = Placement(np.tile(IDENTITY, (n_frames, 1)), np.zeros((n_frames, 3)), meters)
    part = TakePart(motion, owners, world)
    shift = root_locations(part, rig)
    top = rig.bones[owners[0]]
    write_channels(bag, bone_path(top, "location"), top, frames, shift)
    basis = basis_rotations(
        part, rig, Placement(np.array([IDENTITY]), np.zeros((1, 3)), meters)
    )
    for done, (bone, rotations) in enumerate(basis.items()):
        progress(done / len(basis), "Writing keys")
        joint = owners.index(bone)
        if joint == 0 or (motion.rotations[:, joint] != IDENTITY).any():
            _write_rotations(bag, armature.pose.bones[rig.bones[bone]], frames, rotations)
    compat.assign(armature, action, slot)
    return action, slot


def _write_rotations(
    bag: bpy.types.ActionChannelbag, bone: bpy.types.PoseBone, frames: Array, rotations: Array
) -> None:
    observed = np.isfinite(rotations).all(axis=-1)
    if not observed.any():
        return
    name, _ = rotation_property(bone.rotation_mode)
    present = np.array([getattr(bone, name)], dtype=np.float64)
    values = channels_from_quaternions(rotations[observed], bone.rotation_mode, present)
    write_channels(bag, bone_path(bone.name, name), bone.name, frames[observed], values)


def write_channels(
    bag: bpy.types.ActionChannelbag, path: str, group: str, frames: Array, values: Array
) -> None:
    """Write F-Curves for all channels of a property, (n_frames, n); no keys where it is NaN."""
    observed = np.isfinite(values).all(axis=-1)
    if not observed.any():
        return
    for index, column in enumerate(values[observed].T):
        write_first(compat.new_curve(bag, path, index, group), frames[observed], column)
