"""Ghosts of an action before and after a frame, and trails of hands and feet, as arrays."""

from typing import NamedTuple

import bpy
import numpy as np

from ....solvers.arrays import Array, Single
from ....solvers.errors import InvalidMotionError
from ...blender.compat import Source
from ...rigs.target_read import find_roles
from .figures import Figures, figures_at

TRAILED = ("leftHand", "rightHand", "leftFoot", "rightFoot")
NEAR_ALPHA, FAR_ALPHA = 0.6, 0.1
"""Opacity of the nearest and of the farthest ghost, as a fraction of the color's."""
MAX_CACHED = 8
"""Number of cached frames. It bounds the memory."""


class Onion(NamedTuple):
    """Which ghosts are drawn."""

    n_ghosts: int
    """On each side of the frame."""
    step: int
    """Frames from one ghost to the next."""

    @property
    def reach(self) -> int:
        """Frames from the current one to the farthest ghost."""
        return self.n_ghosts * self.step


class FadedLines(NamedTuple):
    """Lines in the armature's space, and how opaque they are."""

    lines: Single
    """Shape (n_lines, 2, 3), no NaN."""
    alphas: Single
    """Shape (n_lines, 2), 0 to 1."""


_Key = tuple[int, int, int, int, Onion]
_cache: dict[_Key, FadedLines] = {}
_trailed: dict[int, tuple[str, ...]] = {}


def onion_at(
    armature: bpy.types.Object, source: Source, frame: float, onion: Onion
) -> FadedLines:
    """Return ghosts and trails of an action around a frame; cached until `forget`."""
    action, slot = source
    key = (armature.session_uid, action.session_uid, slot.handle, round(frame), onion)
    if key not in _cache:
        while len(_cache) >= MAX_CACHED:
            del _cache[next(iter(_cache))]
        first, last = (round(each) for each in action.curve_frame_range)
        middle = round(frame)
        nearby = range(max(middle - onion.reach, first), min(middle + onion.reach, last) + 1)
        figures = _figures_within(armature, source, nearby)
        _cache[key] = faded_lines(figures, _trailed_bones(armature), middle, onion)
    return _cache[key]


def forget() -> None:
    """Clear the caches, so that the next drawing reads again."""
    _cache.clear()
    _trailed.clear()


def _figures_within(armature: bpy.types.Object, source: Source, frames: range) -> list[Figures]:
    """Return the blocks of figures that hold these frames, cut to them."""
    found: list[Figures] = []
    frame = frames.start
    while frame < frames.stop:
        block = figures_at(armature, source, frame)
        rows = slice(frame - block.start, frames.stop - block.start)
        found.append(
            Figures(frame, block.bones, block.heads[rows], block.tails[rows], block.joins)
        )
        frame += len(found[-1].heads)
    return found


def _trailed_bones(armature: bpy.types.Object) -> tuple[str, ...]:
    """Return the bones of hands and feet that are recognized."""
    if armature.session_uid not in _trailed:
        try:
            joints = find_roles(armature).joints
        except InvalidMotionError:
            joints = {}
        _trailed[armature.session_uid] = tuple(
            joints[role] for role in TRAILED if role in joints
        )
    return _trailed[armature.session_uid]


def faded_lines(
    blocks: list[Figures], trailed: tuple[str, ...], frame: int, onion: Onion
) -> FadedLines:
    """Return ghosts, and a trail for each of the trailed bones; both fade with distance."""
    lines, alphas = [np.zeros((0, 2, 3), np.float32)], [np.zeros((0, 2), np.float32)]
    for block in blocks:
        frames = np.arange(block.start, block.start + len(block.heads))
        for each in frames[(frames != frame) & ((frames - frame) % onion.step == 0)]:
            lines.append(block.segments(each))
            alpha = _alphas(np.array([float(each - frame)]), onion)
            alphas.append(np.tile(alpha, (len(lines[-1]), 2)))
    if blocks:
        trails, trail_alphas = _trails(blocks, trailed, frame, onion)
        lines.append(trails)
        alphas.append(trail_alphas)
    return FadedLines(np.concatenate(lines), np.concatenate(alphas))


def _trails(
    blocks: list[Figures], trailed: tuple[str, ...], frame: int, onion: Onion
) -> tuple[Single, Single]:
    bones = [blocks[0].bones.index(bone) for bone in trailed if bone in blocks[0].bones]
    heads = np.concatenate([block.heads[:, bones] for block in blocks])
    alphas = _alphas(np.arange(float(len(heads))) + blocks[0].start - frame, onion)
    trails = np.stack([heads[:-1], heads[1:]], axis=2).reshape(-1, 2, 3)
    ends = np.stack([alphas[:-1], alphas[1:]], axis=1).repeat(len(bones), axis=0)
    observed = np.isfinite(trails).all(axis=(1, 2))
    return trails[observed], ends[observed]


def _alphas(distances: Array, onion: Onion) -> Single:
    """Return the opacity at distances in frames from the current one."""
    knots = (0.0, float(max(onion.reach, 1)))
    found = np.interp(np.abs(distances), knots, (NEAR_ALPHA, FAR_ALPHA))
    return np.asarray(found, np.float32)
