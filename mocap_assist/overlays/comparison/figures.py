"""Stick figures of an armature's actions, raw and clean, as plain arrays."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ....solvers.arrays import Array
from ....solvers.rotations import inverse, multiply, rotate
from ...actions.bone_channels import read_bone
from ...actions.take import BoneChannels
from ...blender import compat
from ...blender.compat import Source
from ...scene import history
from ...scene.rig import Rig, read_rig
from .key_store import Keys, curves_near, read_keys

BLOCK_POSES = 2**13
"""Number of bone poses that are computed at once. It bounds the delay of the drawing."""
MAX_CACHED = 128
"""Number of cached blocks of 200 kB. It bounds the memory."""
MAX_CACHED_ACTIONS = 4
"""Number of actions with cached keys. It bounds the memory: with 120 bones and 10,000 frames 38
MB each."""


@dataclass(frozen=True, eq=False)
class Figures:
    """Keyed bones of an armature over a range of frames, in the armature's space.

    NaN where a bone or one of its ancestors is missing.
    """

    start: int
    """Scene frame of the first row."""
    bones: tuple[str, ...]
    heads: NDArray[np.float32]
    """Shape (n_frames, n_bones, 3), in the armature's unit."""
    tails: NDArray[np.float32]
    joins: tuple[tuple[int, int], ...]
    """Pairs of bones with a line between their heads: a disconnected bone and its parent."""

    def segments(self, frame: float) -> NDArray[np.float32]:
        """Return the lines at a frame or the nearest one: shape (n_lines, 2, 3), no NaN."""
        row = min(max(round(frame) - self.start, 0), len(self.heads) - 1)
        heads, tails = self.heads[row], self.tails[row]
        joins = np.array(self.joins, dtype=np.intp).reshape(-1, 2)
        lines: NDArray[np.float32] = np.concatenate([
            np.stack([heads, tails], axis=1),
            heads[joins],
        ])
        known: NDArray[np.bool_] = np.isfinite(lines).all(axis=(1, 2))
        return lines[known]


def read_figures(
    armature: bpy.types.Object, source: Source, frames: range, keys: Keys | None = None
) -> Figures:
    """Pose the armature by an action alone, at integer frames.

    As in reading takes, constraints, drivers, scale and the bones' inheritance options are
    ignored, and so is the transform of the armature object. `keys` are those of the action if
    they were read before.
    """
    rig = read_rig(armature)
    grid = np.arange(frames.start, frames.stop, dtype=np.float64)
    curves = curves_near(source, read_keys(source) if keys is None else keys, grid)
    channels = [read_bone(armature.pose.bones[bone], curves, grid) for bone in rig.bones]
    heads, tails = _pose(rig, channels)
    keyed = [
        bone for bone, each in enumerate(channels) if each.rotation_keyed or each.location_keyed
    ]
    row = {bone: index for index, bone in enumerate(keyed)}
    joins = tuple(
        (row[rig.parents[bone]], row[bone])
        for bone in keyed
        if rig.parents[bone] in row and not rig.connected[bone]
    )
    names = tuple(rig.bones[bone] for bone in keyed)
    return Figures(
        frames.start,
        names,
        _single_precision(heads, keyed),
        _single_precision(tails, keyed),
        joins,
    )


def _single_precision(points: Array, bones: list[int]) -> NDArray[np.float32]:
    return points[:, bones].astype(np.float32)


def raw_and_clean(armature: bpy.types.Object) -> tuple[Source | None, Source | None]:
    """Return the recorded action and the result to compare.

    The result is the one that the armature plays. If it plays the recorded action, it is the
    newest result of that action in the file.
    """
    result = history.played_result(armature)
    if result is not None:
        return history.raw_of(result[0]), result
    animation = armature.animation_data
    if animation is None or animation.action is None or animation.action_slot is None:
        return None, None
    raw = (animation.action, animation.action_slot)
    results = [
        each
        for each in bpy.data.actions
        if each.get(history.SOURCE) == raw[0] and history.raw_of(each) == raw
    ]
    newest = max(results, key=lambda each: each.session_uid, default=None)
    if newest is None:
        return raw, None
    slot = compat.find_slot(newest, raw[1].identifier)
    return raw, None if slot is None else (newest, slot)


class _BlockKey(NamedTuple):
    """Key of a block of figures; it holds no data-blocks, since undo replaces them."""

    armature: int
    action: int
    slot: int
    frames: range


_cache: dict[_BlockKey, Figures] = {}
_keys: dict[tuple[int, int], Keys] = {}


def figures_at(armature: bpy.types.Object, source: Source, frame: float) -> Figures:
    """Return the figures around a frame; keys are read once and cached until `forget`."""
    action, slot = source
    frames = _block(action, frame, len(armature.data.bones))
    key = _BlockKey(armature.session_uid, action.session_uid, slot.handle, frames)
    if key not in _cache:
        _make_room(_cache, MAX_CACHED)
        _cache[key] = read_figures(armature, source, frames, _keys_of(source))
    return _cache[key]


def forget() -> None:
    """Clear the caches, so that the next drawing reads again."""
    _cache.clear()
    _keys.clear()


def _keys_of(source: Source) -> Keys:
    action, slot = source
    key = (action.session_uid, slot.handle)
    if key not in _keys:
        _make_room(_keys, MAX_CACHED_ACTIONS)
        _keys[key] = read_keys(source)
    return _keys[key]


def _make_room(store: dict[Any, Any], max_entries: int) -> None:
    """Drop the oldest entries."""
    while len(store) >= max_entries:
        del store[next(iter(store))]


def _block(action: bpy.types.Action, frame: float, n_bones: int) -> range:
    """Return the block of integer frames with a frame of the action, or nearest to it."""
    length = max(BLOCK_POSES // n_bones, 1)
    first, last = (round(each) for each in action.curve_frame_range)
    inside = min(max(round(frame), first), last)
    start = first + (inside - first) // length * length
    return range(start, min(start + length, last + 1))


def _pose(rig: Rig, channels: list[BoneChannels]) -> tuple[Array, Array]:
    """Compute heads and tails by forward kinematics, (n_frames, n_bones, 3).

    Bones may translate. All bones of one level are posed at once. `rotations` are relative to
    the rest pose. Gaps spread to descendants.
    """
    rest_rotations, parents = rig.rest_rotations, np.array(rig.parents)
    local_rotations = np.stack([each.rotations for each in channels], axis=1)
    local_rotations = multiply(
        multiply(rest_rotations, local_rotations), inverse(rest_rotations)
    )
    parent_heads = np.where(parents[:, None] < 0, 0.0, rig.heads[parents])
    locations = np.stack([each.locations for each in channels], axis=1)
    offsets = rig.heads - parent_heads + rotate(rest_rotations, locations)
    rotations, heads = local_rotations.copy(), offsets.copy()
    levels = np.array([len(rig.chain_to(bone)) for bone in range(len(rig.bones))])
    for level in range(1, levels.max() + 1):
        bones = np.flatnonzero(levels == level)
        parent_rotations = rotations[:, parents[bones]]
        rotations[:, bones] = multiply(parent_rotations, local_rotations[:, bones])
        heads[:, bones] = heads[:, parents[bones]] + rotate(parent_rotations, offsets[:, bones])
    return heads, heads + rotate(rotations, rig.tails - rig.heads)
