"""Stick figures of an armature's actions, raw and clean, as plain arrays."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.rotations import inverse, multiply, rotate
from ..actions.bone_channels import read_bone
from ..actions.key_store import Keys, curves_near, read_keys
from ..actions.take import BoneChannels
from ..blender import compat
from ..blender.compat import Source
from ..scene import history
from ..scene.rig import Rig, read_rig

Array = NDArray[np.float64]

BLOCK = 2**13
"""Poses of one bone that are worked out at once: so few that nobody waits for a drawing."""
N_KEPT = 128
"""Blocks that are kept, of 200 kB."""
N_ACTIONS = 4
"""Actions whose keys are kept: of 120 bones and 10,000 frames, 38 MB each."""


@dataclass(frozen=True, eq=False)
class Figures:
    """The keyed bones of an armature over some frames, in the armature's own space.

    NaN where a bone, or one above it, was not recorded.
    """

    start: int
    """Scene frame of the first row."""
    bones: tuple[str, ...]
    heads: NDArray[np.float32]
    """Shape (n_frames, n_bones, 3), in the armature's unit."""
    tails: NDArray[np.float32]
    joins: tuple[tuple[int, int], ...]
    """Pairs of bones whose heads are drawn joined: a bone that hangs free, and its parent."""

    def segments(self, frame: float) -> NDArray[np.float32]:
        """Return the lines at a frame, or at the nearest one: shape (n_lines, 2, 3), no NaN."""
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
    """Pose the armature by an action alone, over some whole frames.

    As in reading takes, constraints, drivers, scale and the bones' inheritance options are
    not looked at; the armature object's own place is left out. `keys` are those of the action,
    if they were read before.
    """
    rig = read_rig(armature)
    grid = np.arange(frames.start, frames.stop, dtype=np.float64)
    curves = curves_near(source, read_keys(source) if keys is None else keys, grid)
    channels = [read_bone(armature.pose.bones[bone], curves, grid) for bone in rig.bones]
    heads, tails = _pose(rig, channels)
    keyed = [
        bone for bone, each in enumerate(channels) if each.rotation_keyed or each.location_keyed
    ]
    place = {bone: index for index, bone in enumerate(keyed)}
    joins = tuple(
        (place[rig.parents[bone]], place[bone])
        for bone in keyed
        if rig.parents[bone] in place and not rig.connected[bone]
    )
    names = tuple(rig.bones[bone] for bone in keyed)
    return Figures(frames.start, names, _single(heads, keyed), _single(tails, keyed), joins)


def _single(points: Array, bones: list[int]) -> NDArray[np.float32]:
    return points[:, bones].astype(np.float32)


def raw_and_clean(armature: bpy.types.Object) -> tuple[Source | None, Source | None]:
    """Return the recorded action and the result to compare.

    That is the result which the armature plays or, where it plays the recorded action, the
    last one in the file that was made from it.
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


class _Key(NamedTuple):
    """Names a block of figures without holding anything of Blender's, which undo replaces."""

    armature: int
    action: int
    slot: int
    frames: range


_kept: dict[_Key, Figures] = {}
_keys: dict[tuple[int, int], Keys] = {}


def figures_at(armature: bpy.types.Object, source: Source, frame: float) -> Figures:
    """Return the figures around a frame; keys are read once, then kept until `forget`."""
    action, slot = source
    frames = _block(action, frame, len(armature.data.bones))
    key = _Key(armature.session_uid, action.session_uid, slot.handle, frames)
    if key not in _kept:
        _make_room(_kept, N_KEPT)
        _kept[key] = read_figures(armature, source, frames, _keys_of(source))
    return _kept[key]


def forget() -> None:
    """Read everything anew when it is drawn next."""
    _kept.clear()
    _keys.clear()


def _keys_of(source: Source) -> Keys:
    action, slot = source
    key = (action.session_uid, slot.handle)
    if key not in _keys:
        _make_room(_keys, N_ACTIONS)
        _keys[key] = read_keys(source)
    return _keys[key]


def _make_room(store: dict[Any, Any], n_kept: int) -> None:
    """Forget what was read first."""
    while len(store) >= n_kept:
        del store[next(iter(store))]


def _block(action: bpy.types.Action, frame: float, n_bones: int) -> range:
    """Return the block of whole frames of the action that a frame is in, or is nearest to."""
    length = max(BLOCK // n_bones, 1)
    first, last = (round(each) for each in action.curve_frame_range)
    inside = min(max(round(frame), first), last)
    start = first + (inside - first) // length * length
    return range(start, min(start + length, last + 1))


def _pose(rig: Rig, channels: list[BoneChannels]) -> tuple[Array, Array]:
    """Forward kinematics with bones that shift: heads and tails, (n_frames, n_bones, 3).

    All bones of one generation are posed at once. `turns` are out of the rest pose. Gaps
    spread downwards.
    """
    rest, parents = rig.rest_rotations, np.array(rig.parents)
    own = np.stack([each.rotations for each in channels], axis=1)
    own = multiply(multiply(rest, own), inverse(rest))
    hinges = np.where(parents[:, None] < 0, 0.0, rig.heads[parents])
    shifts = np.stack([each.locations for each in channels], axis=1)
    offsets = rig.heads - hinges + rotate(rest, shifts)
    turns, heads = own.copy(), offsets.copy()
    generations = np.array([len(rig.chain_to(bone)) for bone in range(len(rig.bones))])
    for generation in range(1, generations.max() + 1):
        bones = np.flatnonzero(generations == generation)
        above = turns[:, parents[bones]]
        turns[:, bones] = multiply(above, own[:, bones])
        heads[:, bones] = heads[:, parents[bones]] + rotate(above, offsets[:, bones])
    return heads, heads + rotate(turns, rig.tails - rig.heads)
