"""Unbake: read the scene and write the result."""

from functools import partial

import bpy
import numpy as np

from ...solvers.motion import Motion
from ...solvers.rotations import inverse, multiply
from ..actions.armature_read import read_take
from ..actions.armature_write import Output, assign_result, check_writable
from ..actions.bone_channels import animated_curves
from ..actions.take import ArmatureTake, TakePart
from ..blender.time_slices import Sliced, Steps, in_thread
from ..runtime.played import Played
from ..runtime.selection import played_source
from ..runtime.subject import check_unchanged
from ..scene import history
from .button_settings import UnbakeBundle
from .solve_unbaking import BoneShape, KeyedMotion, Unbaked, UnbakeProblem, unbake
from .sparse_write import count_keys, write_sparse


@Sliced
def read_unbaking(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: UnbakeBundle
) -> "Steps[partial[Unbaked]]":
    """Read the action that an armature plays; return the picklable solve."""
    check_writable(armature)
    take = yield from read_take.steps(armature, scene, source=played_source(armature))
    problem = yield from in_thread.steps(partial(_problem, take, settings))
    return partial(unbake, problem)


@Sliced
def write_unbaked(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    settings: UnbakeBundle,
    result: Unbaked,
    solved_digest: str | None = None,
) -> Steps[str]:
    """Write a copy of the action with few keys and put it to use; return a sentence."""
    read = Played.of(scene, armature)
    take = yield from read_take.steps(armature, scene, source=played_source(armature))
    problem = yield from in_thread.steps(partial(_problem, take, settings))
    yield from check_unchanged.steps(read.find()[1], solved_digest, problem)
    action, slot = yield from write_sparse.steps(read, take.grid, result.keys)
    _, armature, played = read.find()
    before, after = (count_keys(animated_curves(*each)) for each in (played, (action, slot)))
    entry = {
        "operation": "reduce_keys",
        "settings": history.json_ready(*settings),
        "keys_before": before,
        "keys_after": after,
        "error_cm": 100 * result.error,
    }
    history.record(action, played, entry)
    assign_result(armature, action, slot, Output.ACTION)
    return (
        f"{action.name}: {before} → {after} keys; error of hands, feet and head"
        f" at most {100 * result.error:.2f} cm."
    )


def _problem(take: ArmatureTake, settings: UnbakeBundle) -> UnbakeProblem:
    trees = tuple(_tree(take, part) for part in take.parts)
    return UnbakeProblem(trees, settings.choices.tolerance, settings.unbaking)


def _tree(take: ArmatureTake, part: TakePart) -> KeyedMotion:
    """Return a part as it moves within what carries it, which keeps its own keys."""
    rig, rest, root = take.rig, take.rest, part.bones[0]
    rotation = rest.rotations[0]
    motion = part.motion
    rotations = motion.rotations.copy()
    carried = multiply(part.carrier.rotations, inverse(rotation))
    rotations[:, 0] = multiply(inverse(carried), rotations[:, 0])
    positions = rest.points(part.carrier.points_back(motion.root_positions))
    axes = multiply(rotation, rig.rest_rotations)
    shapes = tuple(
        None
        if bone < 0
        else BoneShape(
            rig.bones[bone], rig.modes[bone], axes[bone], take.channels[bone].rotation_keyed
        )
        for bone in part.bones
    )
    return KeyedMotion(
        Motion(motion.skeleton, rotations, positions, motion.frame_rate),
        shapes,
        take.channels[root].location_keyed,
        np.asarray(rest.points(rig.heads[root])),
        rest.scale,
    )
