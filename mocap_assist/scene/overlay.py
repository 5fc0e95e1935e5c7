"""Stick figures of an armature's actions, raw and clean, as plain arrays."""

from dataclasses import dataclass
from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.motion.rotations import inverse, multiply, rotate
from . import compat, history
from .bone_channels import animated_curves, read_bone
from .compat import Source
from .rig import Rig, read_rig
from .take import BoneChannels

Array = NDArray[np.float64]

BLOCK = 2**19
"""Poses of one bone that are read at once: 12 MB. Most takes are a single block."""
N_KEPT = 4
"""Blocks that are kept."""


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
        lines = np.concatenate([np.stack([heads, tails], axis=1), heads[joins]])
        return lines[np.isfinite(lines).all(axis=(1, 2))]


def read_figures(armature: bpy.types.Object, source: Source, frames: range) -> Figures:
    """Pose the armature by an action alone, over some whole frames.

    As in reading takes, constraints, drivers, scale and the bones' inheritance options are
    not looked at; the armature object's own place is left out.
    """
    rig, curves = read_rig(armature), animated_curves(*source)
    grid = np.arange(frames.start, frames.stop, dtype=np.float64)
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
    single = (each[:, keyed].astype(np.float32) for each in (heads, tails))
    return Figures(frames.start, names, *single, joins)


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
    slot = compat.slot_called(newest, raw[1].identifier)
    return raw, None if slot is None else (newest, slot)


class _Key(NamedTuple):
    """Names a block of figures without holding anything of Blender's, which undo replaces."""

    armature: int
    action: int
    slot: int
    frames: range


_kept: dict[_Key, Figures] = {}


def figures_at(armature: bpy.types.Object, source: Source, frame: float) -> Figures:
    """Return the figures around a frame; read once, then kept until `forget`."""
    action, slot = source
    frames = _block(action, frame, len(armature.data.bones))
    key = _Key(armature.session_uid, action.session_uid, slot.handle, frames)
    if key not in _kept:
        while len(_kept) >= N_KEPT:
            del _kept[next(iter(_kept))]
        _kept[key] = read_figures(armature, source, frames)
    return _kept[key]


def forget() -> None:
    """Read everything anew when it is drawn next."""
    _kept.clear()


def _block(action: bpy.types.Action, frame: float, n_bones: int) -> range:
    """Return the block of whole frames of the action that a frame is in, or is nearest to."""
    length = max(BLOCK // n_bones, 1)
    first, last = (round(each) for each in action.curve_frame_range)
    inside = min(max(round(frame), first), last)
    start = first + (inside - first) // length * length
    return range(start, min(start + length, last + 1))


def _pose(rig: Rig, channels: list[BoneChannels]) -> tuple[Array, Array]:
    """Forward kinematics with bones that shift: heads and tails, (n_frames, n_bones, 3).

    `turn` is a bone's turn out of its rest pose. Gaps spread downwards.
    """
    n_frames = len(channels[0].rotations)
    turns = np.empty((n_frames, len(rig.bones), 4))
    heads, tails = (np.empty((n_frames, len(rig.bones), 3)) for _ in range(2))
    still, origin = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3)
    for bone, parent in enumerate(rig.parents):
        rest, each = rig.rest_rotations[bone], channels[bone]
        own = multiply(multiply(rest, each.rotations), inverse(rest))
        above = turns[:, parent] if parent >= 0 else still
        base = heads[:, parent] if parent >= 0 else origin
        hinge = rig.heads[parent] if parent >= 0 else origin
        offset = rig.heads[bone] - hinge + rotate(rest, each.locations)
        turns[:, bone] = multiply(above, own)
        heads[:, bone] = base + rotate(above, offset)
        arm = rotate(turns[:, bone], rig.tails[bone] - rig.heads[bone])
        tails[:, bone] = heads[:, bone] + arm
    return heads, tails
