"""Read an armature's action as a take."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.errors import InvalidMotionError
from ...solvers.motion import Tracks
from ...solvers.motion.rotations import multiply, rotate
from .body import body_root
from .bone_channels import animated_curves, bone_path, read_bone, read_space
from .compat import Source
from .frames import FrameRange, Grid, key_grid, range_bounds
from .history import was_thinned
from .origin import origin_of
from .rig import Placement, Rig, read_rig
from .take import ArmatureTake, BoneChannels, part_of
from .units import metres_per_unit

Array = NDArray[np.float64]


def read_take(
    armature: bpy.types.Object,
    scene: bpy.types.Scene,
    choice: FrameRange = FrameRange.ACTION,
    source: Source | None = None,
    grid: Grid | None = None,
) -> ArmatureTake:
    """Read an action, by default the armature's own, through its F-Curves in bulk.

    Parameters
    ----------
    armature : an armature object
        May be linked or overridden: nothing is written.
    scene : bpy.types.Scene
        Its frame rate and ranges.
    choice : FrameRange
    source : action and slot
        Others that fit the armature.
    grid : Grid
        Moments to read at, in the place of those of the keys within `choice`.

    Returns
    -------
    ArmatureTake
        NaN where a densely keyed bone has no keys (see `gaps.unobserved`). Muted channels
        count as not keyed, channels without keys have their present value. Constraints,
        drivers, scale and the bones' inheritance options are not looked at; the way back is
        exact all the same.

    Raises
    ------
    InvalidMotionError
        There is no action, slot, bone, key or uniform scale, as the sentence says.
    """
    action, slot = source or action_of(armature)
    thinned = was_thinned(action)
    curves, recorded = animated_curves(action, slot), bool(origin_of(action)) and not thinned
    rig = read_rig(armature)
    if grid is None:
        known = {bone_path(bone, "") for bone in rig.bones}
        keyed = [curve for (path, _), curve in curves.items() if _owner(path) in known]
        grid = key_grid(keyed, range_bounds(choice, scene, keyed), recorded=recorded)
    channels = tuple(
        read_bone(
            armature.pose.bones[bone],
            curves,
            grid.frames,
            grid.step if recorded else None,
            gaps=not thinned,
        )
        for bone in rig.bones
    )
    space = read_space(armature, curves, grid.frames)
    root = body_root(rig, [each.travels for each in channels])
    space = space.in_unit(metres_per_unit(scene, rig, root, space.scale))
    rate = scene.render.fps / scene.render.fps_base / grid.step
    return _assembled(rig, root, grid, channels, space, rate)


def action_of(armature: bpy.types.Object) -> Source:
    """Return the action and slot that animate an armature, or say which of them is missing."""
    animation = armature.animation_data
    if animation is None or animation.action is None:
        raise InvalidMotionError(f"{armature.name} has no action. Assign or import one.")
    if animation.action_slot is None:
        raise InvalidMotionError(
            f"{armature.name} uses no slot of its action {animation.action.name}. Choose the"
            " slot in the Action Editor."
        )
    return animation.action, animation.action_slot


def _assembled(
    rig: Rig,
    root: int,
    grid: Grid,
    channels: tuple[BoneChannels, ...],
    space: Placement,
    rate: float,
) -> ArmatureTake:
    rest = Placement(space.rotations[:1], space.origins[:1], space.scale)
    carrier, above = space, rig.chain_to(root)
    for bone in above:
        axes = rig.rest_rotations[bone]
        turn = multiply(multiply(axes, channels[bone].rotations), axes * (1, -1, -1, -1))
        shift = rotate(axes, channels[bone].locations)
        carrier = carrier.moved(_filled(turn), np.nan_to_num(shift), rig.heads[bone])
    parts = [part_of(rig, rig.subtree(root), channels, carrier, rest, rate)]
    inside = {*above, *parts[0].bones}
    for bone, parent in enumerate(rig.parents):
        if bone in inside or not (parent < 0 or parent in above):
            continue
        tree = rig.subtree(bone)
        inside |= set(tree)
        if any(channels[each].rotation_keyed or channels[each].travels for each in tree):
            parts.append(part_of(rig, tree, channels, rest, rest, rate))
    roots = {part.bones[0] for part in parts} | set(above)
    offsets = _read_offsets(rig, channels, rest, rate, roots)
    return ArmatureTake(rig, grid, tuple(parts), offsets, channels, rest)


def _read_offsets(
    rig: Rig,
    channels: tuple[BoneChannels, ...],
    rest: Placement,
    rate: float,
    roots: set[int],
) -> Tracks | None:
    """Locations of the bones that shift within a tree, in their parents' rest axes, metres."""
    shifting = [
        bone for bone, each in enumerate(channels) if each.travels and bone not in roots
    ]
    if not shifting:
        return None
    positions = [
        rest.scale
        * rotate(
            multiply(rest.rotations[0], rig.rest_rotations[bone]), channels[bone].locations
        )
        for bone in shifting
    ]
    names = tuple(rig.bones[bone] for bone in shifting)
    return Tracks(names, np.stack(positions, axis=1), rate)


def _filled(rotations: Array) -> Array:
    """Take the last known turn through the gaps of a bone that is not cleaned itself."""
    known = np.isfinite(rotations).all(axis=-1)
    last = np.maximum.accumulate(np.where(known, np.arange(len(known)), 0))
    return np.where(known[last, None], rotations[last], (1.0, 0.0, 0.0, 0.0))


def _owner(path: str) -> str:
    """Return the part of a channel's data path that names the bone."""
    return path[: path.rfind(".") + 1]
