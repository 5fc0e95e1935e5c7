"""A result as an additive NLA track above the recorded action, with an influence to dial."""

from collections.abc import Iterator, Sequence

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.rotations import inverse, multiply, unroll
from ..blender import compat
from ..blender.block_references import (
    BlockReference,
    SourceReference,
    changed_during_solve,
    kept_when_complete,
)
from ..blender.compat import Source
from ..blender.time_slices import Sliced, Steps, should_yield
from ..scene import history
from .armature_write import NUMBERED, check_writable, identify_played, keep_replaced
from .bone_channels import Curves, animated_curves, curves_of, sampled
from .curves import deselect, write_first
from .nla_strips import (
    delta_tracks,
    new_strip,
    play_in_place,
    put_at_own_frames,
    remove_deltas,
)
from .rotation_modes import quaternions_from_channels
from .unchanged_samples import MIN_CHANGE

SUFFIX = ".delta"
N_CHANNELS = {
    "location": 3,
    "rotation_euler": 3,
    "rotation_quaternion": 4,
    "rotation_axis_angle": 4,
}
"""Properties of a bone that a result may change, and how many channels each has."""


@Sliced
def write_delta(armature: bpy.types.Object, base: Source, result: Source) -> Steps[Source]:
    """Make an action that leads from the pose of `base` to that of `result` when combined.

    Blender's NLA combines by channel: it multiplies quaternions and adds all else. Channels
    that are equal are left out. A key of `base` that is not a number has no delta.

    Raises
    ------
    InvalidMotionError
        Between two time slices a bone was deleted, or the armature was made to play another
        action.
    """
    action = bpy.data.actions.new(NUMBERED.sub("", base[0].name) + SUFFIX)
    slot = action.slots.new(armature.id_type, result[1].name_display)
    here, made = BlockReference.of(armature), SourceReference.of((action, slot))
    sources = SourceReference.of(base), SourceReference.of(result)
    names, playing = armature.pose.bones.keys(), identify_played(armature)
    before, after = animated_curves(*base), animated_curves(*result)
    with kept_when_complete(action):
        for number, name in enumerate(names):
            bone, bag = here.find().pose.bones.get(name), compat.ensure_channelbag(*made.find())
            if bone is None:
                raise changed_during_solve(here.name)
            for path, frames, deltas in _deltas(bone, before, after):
                for index, column in deltas.items():
                    curve = compat.new_curve(bag, path, index, name)
                    write_first(curve, frames, np.nan_to_num(column))
                    deselect(curve)
            if should_yield():
                yield number / len(names)
                before, after = (animated_curves(*source.find()) for source in sources)
                if identify_played(here.find()) != playing:
                    raise changed_during_solve(here.name)
        action, _ = made.find()
        history.mark_delta(action, *(source.find() for source in sources))
    return made.find()


def _deltas(
    bone: bpy.types.PoseBone, before: Curves, after: Curves
) -> Iterator[tuple[str, Array, dict[int, Array]]]:
    """Yield path, frames and delta by channel of each property of a bone that differs."""
    for name, n_channels in N_CHANNELS.items():
        path = bone.path_from_id(name)
        old, new = (curves_of(each, path, n_channels) for each in (before, after))
        if not old or not new:
            continue
        times = [channel.keys[:, 0] for channel in (*old.values(), *new.values())]
        frames = np.unique(np.concatenate(times))
        values = [sampled(each, getattr(bone, name), frames) for each in (old, new)]
        if np.abs(values[1] - values[0]).max() < MIN_CHANGE:
            continue
        if name == "rotation_quaternion":
            raw, clean = (quaternions_from_channels(each, "QUATERNION") for each in values)
            identity = np.array([[1.0, 0.0, 0.0, 0.0]])
            delta = unroll(np.concatenate([identity, multiply(inverse(raw), clean)]))[1:]
            yield path, frames, dict(enumerate(delta.T))
        else:
            columns = (values[1] - values[0]).T
            yield path, frames, {index: columns[index] for index in new}


def lay_delta(armature: bpy.types.Object, base: Source, delta: Source) -> None:
    """Let an armature play the base action on an NLA track, and the delta on one above it.

    An earlier delta of the same base is replaced in its strip, which keeps its influence, with
    keys, and its timing. Where tracks have other strips, too, new ones are made with the
    influence of the earlier delta. It is a free value: it can be dialed, and keyed.

    Raises
    ------
    InvalidMotionError
        Nothing can be assigned to the armature; see `check_writable`.
    """
    check_writable(armature)
    animation = armature.animation_data
    earlier = delta_tracks(animation, base[0])
    is_pair = [len(pair) for pair in earlier] == [2]
    if is_pair and all(len(track.strips) == 1 for track in earlier[0]):
        _play_again(earlier[0], delta)
    else:
        dialed = [strip.influence for *_, track in earlier for strip in track.strips]
        remove_deltas(animation, base[0])
        below = new_strip(animation, base)
        below.blend_type = animation.action_blend_type
        _free_influence(below, animation.action_influence)
        strip = new_strip(animation, delta)
        strip.blend_type = "COMBINE"
        _free_influence(strip, dialed[-1] if dialed else 1.0)
    keep_replaced(animation, (base[0], delta[0]))
    animation.action = None


def _play_again(pair: Sequence[bpy.types.NlaTrack], delta: Source) -> None:
    """Let the upper one of two tracks with a strip each play a new delta.

    Both strips stay where the animator moved and scaled them. A delta of other frames would
    not fit there: then both play at the frames of their actions.
    """
    for track in pair:
        track.mute = track.strips[0].mute = False
    below, strip = (track.strips[0] for track in pair)
    if not play_in_place(strip, delta):
        put_at_own_frames(below)


def _free_influence(strip: bpy.types.NlaStrip, value: float) -> None:
    """Give a strip an influence that can be set and keyed; by default Blender computes it."""
    strip.use_animated_influence = True
    for curve in strip.fcurves:
        if curve.data_path == "influence":
            for key in list(curve.keyframe_points):  # Blender adds one, of the value 0
                curve.keyframe_points.remove(key)
    strip.influence = value


def delta_strip(armature: bpy.types.Object) -> bpy.types.NlaStrip | None:
    """Return the strip of the delta that an armature plays, or None."""
    animation = armature.animation_data
    strips = [] if animation is None else history.playing_strips(animation)
    return next(
        (each for each in strips if each.action and history.base_of_delta(each.action)), None
    )
