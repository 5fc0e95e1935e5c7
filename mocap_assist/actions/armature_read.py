"""Read an armature's action as a take."""

from functools import partial

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.errors import InvalidMotionError
from ...solvers.motion import Tracks
from ...solvers.rotations import multiply, rotate
from ..blender.block_references import BlockReference, SourceReference
from ..blender.compat import Source
from ..blender.time_slices import Sliced, Steps, in_thread, should_yield
from ..scene.body import body_root
from ..scene.history import playing_strips, was_thinned
from ..scene.origin import origin_of
from ..scene.rig import Placement, Rig, read_rig
from ..scene.units import meters_per_unit
from .bone_channels import animated_curves, bone_path, read_bone, read_space
from .curves import Channel
from .frames import FrameRange, Grid, key_grid, range_bounds
from .take import ArmatureTake, BoneChannels, part_of


@Sliced
def read_take(
    armature: bpy.types.Object,
    scene: bpy.types.Scene,
    choice: FrameRange = FrameRange.ACTION,
    source: Source | None = None,
    grid: Grid | None = None,
    root: str = "",
    holds_ends: bool = False,
) -> Steps[ArmatureTake]:
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
        Frames to read instead of those of the keys within `choice`.
    root : str
        Bone that the body begins with; empty estimates it from the bones that travel.
    holds_ends : bool
        Whether bones hold their pose before their first and after their last key.

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
        There is no action, slot, bone, key or uniform scale, the keys are too far apart, or
        a data-block was deleted between two time slices.
    """
    action, slot = source or action_of(armature)
    thinned = was_thinned(action)
    recorded = bool(origin_of(action)) and not thinned
    rig = read_rig(armature)
    keyed = _Keyed(armature, scene, (action, slot))
    yield from keyed.read_keys()
    if grid is None:
        own = keyed.curves_of_bones(rig)
        bounds = range_bounds(choice, keyed.scene, own, keyed.armature)
        grid = key_grid(own, bounds, recorded=recorded)
    channels, travels = [], []
    for number, bone in enumerate(rig.bones):
        step = grid.step if recorded else None
        pose_bone = keyed.pose_bone(bone)
        about = {"gaps": not thinned, "holds_ends": holds_ends}
        channels.append(read_bone(pose_bone, keyed.curves, grid.frames, step, **about))
        travels.append(channels[-1].travels)
        if should_yield():
            yield 0.2 + 0.5 * number / len(rig.bones)
            keyed.find_again()
    if not any(_is_captured(each) for each in channels):
        raise InvalidMotionError(
            f"All keys of {armature.name} are NaN: nothing was captured. Import the take again."
        )
    space = read_space(keyed.armature, keyed.curves, grid.frames)
    top = rig.bones.index(root) if root in rig.bones else body_root(rig, travels)
    space = space.in_unit(meters_per_unit(keyed.scene, rig, top, space.scale))
    rate = keyed.scene.render.fps / keyed.scene.render.fps_base / grid.step
    return (yield from _assemble_take(rig, top, grid, tuple(channels), space, rate))


def _is_captured(bone: BoneChannels) -> bool:
    """Whether any key of a bone has a value."""
    return bool(
        (bone.rotation_keyed and np.isfinite(bone.rotations).any())
        or (bone.location_keyed and np.isfinite(bone.locations).any())
    )


class _Keyed:
    """An armature, a scene and an action's curves, which may have to be found again."""

    def __init__(
        self, armature: bpy.types.Object, scene: bpy.types.Scene, source: Source
    ) -> None:
        self._lasting = (
            BlockReference.of(armature),
            BlockReference.of(scene),
            SourceReference.of(source),
        )
        self.armature, self.scene = armature, scene
        self.curves = animated_curves(*source)

    def find_again(self) -> None:
        """Replace pointers that may be stale; keep keys that were read."""
        armature, scene, source = self._lasting
        self.armature, self.scene = armature.find(), scene.find()
        before = self.curves
        self.curves = {
            name: channel.with_keys_of(before.get(name))
            for name, channel in animated_curves(*source.find()).items()
        }

    def read_keys(self) -> Steps[None]:
        """Read the keys of all curves."""
        names = list(self.curves)
        for number, name in enumerate(names):
            if name in self.curves:
                self.curves[name].read_keys()
            if should_yield():
                yield 0.2 * number / len(names)
                self.find_again()

    def curves_of_bones(self, rig: Rig) -> list[Channel]:
        """Return the curves that animate the bones of a rig."""
        known = {bone_path(bone, "") for bone in rig.bones}
        return [curve for (path, _), curve in self.curves.items() if _owner(path) in known]

    def pose_bone(self, name: str) -> bpy.types.PoseBone:
        """Return a bone; raise InvalidMotionError if it was deleted between two time slices."""
        bone = self.armature.pose.bones.get(name)
        if bone is None:
            raise InvalidMotionError(
                f"The bone {name} was deleted while it was read. Press the button again."
            )
        return bone


def action_of(armature: bpy.types.Object) -> Source:
    """Return the action and slot of an armature; raise InvalidMotionError without them."""
    animation = armature.animation_data
    if animation is not None and animation.action is None and playing_strips(animation):
        raise InvalidMotionError(
            f"{armature.name} plays NLA strips, not an action. Bake them to one first: Pose >"
            " Animation > Bake Action."
        )
    if animation is None or animation.action is None:
        raise InvalidMotionError(f"{armature.name} has no action. Assign or import one.")
    if animation.action_slot is None:
        raise InvalidMotionError(
            f"{armature.name} uses no slot of its action {animation.action.name}. Choose the"
            " slot in the Action Editor."
        )
    return animation.action, animation.action_slot


def _assemble_take(
    rig: Rig,
    root: int,
    grid: Grid,
    channels: tuple[BoneChannels, ...],
    space: Placement,
    rate: float,
) -> Steps[ArmatureTake]:
    rest = Placement(space.rotations[:1], space.origins[:1], space.scale)
    carrier, above = space, rig.chain_to(root)
    for bone in above:
        axes = rig.rest_rotations[bone]
        rotation = multiply(multiply(axes, channels[bone].rotations), axes * (1, -1, -1, -1))
        shift = rotate(axes, channels[bone].locations)
        carrier = carrier.moved(
            _hold_last_rotation(rotation), np.nan_to_num(shift), rig.heads[bone]
        )
    body = yield from part_of.steps(rig, rig.subtree(root), channels, carrier, rest, rate)
    parts = [body]
    inside = {*above, *parts[0].bones}
    for bone, parent in enumerate(rig.parents):
        if bone in inside or not (parent < 0 or parent in above):
            continue
        tree = rig.subtree(bone)
        inside |= set(tree)
        if any(channels[each].rotation_keyed or channels[each].travels for each in tree):
            part = yield from part_of.steps(rig, tree, channels, rest, rest, rate)
            parts.append(part)
    roots = {part.bones[0] for part in parts} | set(above)
    read_offsets = partial(_read_offsets, rig, channels, rest, rate, roots)
    offsets = yield from in_thread.steps(read_offsets)
    return ArmatureTake(rig, grid, tuple(parts), offsets, channels, rest)


def _read_offsets(
    rig: Rig,
    channels: tuple[BoneChannels, ...],
    rest: Placement,
    rate: float,
    roots: set[int],
) -> Tracks | None:
    """Locations of the bones that shift within a tree, in their parents' rest axes, meters."""
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


def _hold_last_rotation(rotations: Array) -> Array:
    """Hold the last observed rotation through the gaps of a bone that is not cleaned."""
    known = np.isfinite(rotations).all(axis=-1)
    last = np.maximum.accumulate(np.where(known, np.arange(len(known)), 0))
    return np.where(known[last, None], rotations[last], (1.0, 0.0, 0.0, 0.0))


def _owner(path: str) -> str:
    """Return the part of a channel's data path that names the bone."""
    return path[: path.rfind(".") + 1]
