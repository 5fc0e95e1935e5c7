"""Length of one of Blender's units, in meters."""

import bpy

from ...solvers.recordings.conventions import STATED_REACH_M, guess_unit, longest_bone_path
from .rig import Rig


def unit_of(scene: bpy.types.Scene) -> float:
    """Return the length of one unit, in meters, that the scene states."""
    settings = scene.unit_settings
    return float(settings.scale_length) if settings.system != "NONE" else 1.0


def meters_per_unit(scene: bpy.types.Scene, rig: Rig, root: int, scale: float) -> float:
    """Return the scene's unit, or the likely one of the file where the body would be absurd.

    Parameters
    ----------
    scene : bpy.types.Scene
    rig : Rig
    root : int
        The bone that carries the body.
    scale : float
        Of the armature in the scene.
    """
    stated = unit_of(scene)
    bones = rig.subtree(root)
    joint_of = {bone: joint for joint, bone in enumerate(bones)}
    parents = [-1, *(joint_of[rig.parents[bone]] for bone in bones[1:])]
    offsets = scale * (rig.heads[bones] - rig.heads[[rig.parents[bone] for bone in bones]])
    low, high = STATED_REACH_M
    if low <= stated * longest_bone_path(parents, offsets) <= high:
        return float(stated)
    guessed = guess_unit(parents, offsets)
    return (
        guessed
        if low <= guessed * longest_bone_path(parents, offsets) <= high
        else float(stated)
    )
