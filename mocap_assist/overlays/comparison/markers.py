"""Positions and trails of a take's markers, raw and clean, as plain arrays."""

from dataclasses import dataclass
from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ....solvers.arrays import Array
from ...actions.bone_channels import animated_curves, curves_of, gaps_of, sampled
from ...actions.markers.holders import PATH, markers_of, source_of
from ...blender.compat import Source
from ...scene import history
from ...scene.played_time import played_time
from ...scene.units import unit_of

TRAIL_S = 0.2
"""Length of a trail before and after the current frame."""
CROSS_RADIUS_M = 0.006
"""Half the width of a marker's cross."""
BLOCK_FRAMES = 1000
"""Frames that are read at once."""
MAX_CACHED = 8
"""Number of cached blocks. It bounds the memory: with 41 markers a block has 500 kB."""


@dataclass(frozen=True, eq=False)
class Trails:
    """Markers at integer frames of a take; NaN where a marker is missing."""

    start: int
    """Scene frame of the first row."""
    positions: NDArray[np.float32]
    """Shape (n_frames, n_markers, 3), in the space of each marker, in Blender's unit."""

    def segments(self, frame: float, reach: int, size: float, spaces: Array) -> Array:
        """Return a cross and a trail for each marker at a frame, or at the nearest one.

        Parameters
        ----------
        frame : float
        reach : int
            Frames of the trail to either side.
        size : float
            Half the width of a cross, in Blender's unit.
        spaces : shape (n_markers, 4, 4)
            From the space of each marker to the world.

        Returns
        -------
        shape (n_lines, 2, 3), in the world, no NaN
        """
        row = min(max(round(frame) - self.start, 0), len(self.positions) - 1)
        first = max(row - reach, 0)
        nearby = np.einsum(
            "mij,fmj->fmi", spaces[:, :3, :3], self.positions[first : row + reach + 1]
        )
        nearby += spaces[:, :3, 3]
        trails = np.stack([nearby[:-1], nearby[1:]], axis=2).reshape(-1, 2, 3)
        arms = size * np.stack([-np.eye(3), np.eye(3)], axis=1)
        crosses = (nearby[row - first][:, None, None] + arms).reshape(-1, 2, 3)
        lines: Array = np.concatenate([crosses, trails])
        observed: NDArray[np.bool_] = np.isfinite(lines).all(axis=(1, 2))
        return lines[observed]


class ComparedMarkers(NamedTuple):
    """Markers, and what they play in one of the two takes to compare."""

    markers: tuple[bpy.types.Object, ...]
    sources: tuple[Source, ...]


_cache: dict[tuple[tuple[tuple[int, int, int], ...], range], Trails] = {}


def raw_and_clean(holder: bpy.types.Object) -> tuple[ComparedMarkers, ComparedMarkers]:
    """Return the markers below an object with their recorded action and with their result.

    The result is the one that a marker plays. If it plays the recorded action, it is the newest
    result of that action in the file. The second value leaves out markers without a result.
    """
    newest = _newest_results()
    raw: list[tuple[bpy.types.Object, Source]] = []
    clean: list[tuple[bpy.types.Object, Source]] = []
    for marker in markers_of(holder):
        played = source_of(marker)
        recorded = history.raw_of(*played)
        raw.append((marker, recorded or played))
        result = played if recorded else _same_slot(newest.get(played[0]), played)
        if result is not None:
            clean.append((marker, result))
    return _join_markers(raw), _join_markers(clean)


def _newest_results() -> dict[bpy.types.Action, bpy.types.Action]:
    """Return the newest result in the file of each recorded action."""
    by_age = sorted(bpy.data.actions, key=lambda each: each.session_uid)
    results = [(each.get(history.SOURCE), each) for each in by_age]
    return {raw: each for raw, each in results if isinstance(raw, bpy.types.Action)}


def _same_slot(action: bpy.types.Action | None, like: Source) -> Source | None:
    slots = () if action is None else action.slots
    matching = next((slot for slot in slots if slot.handle == like[1].handle), None)
    return None if matching is None else (action, matching)


def _join_markers(pairs: list[tuple[bpy.types.Object, Source]]) -> ComparedMarkers:
    return ComparedMarkers(
        tuple(marker for marker, _ in pairs), tuple(source for _, source in pairs)
    )


def lines_at(played: ComparedMarkers, scene: bpy.types.Scene) -> Array:
    """Return the lines of markers at the scene's frame, in the world: (n_lines, 2, 3)."""
    if not played.markers:
        return np.zeros((0, 2, 3))
    spaces = [each.matrix_world @ each.matrix_basis.inverted_safe() for each in played.markers]
    reach = round(TRAIL_S * scene.render.fps / scene.render.fps_base)
    frame = scene.frame_current_final
    frame = played_time(played.markers[0], frame).action_frame(frame)
    size = CROSS_RADIUS_M / unit_of(scene)
    return trails_at(played, frame, reach).segments(frame, reach, size, np.array(spaces))


def trails_at(played: ComparedMarkers, frame: float, reach: int) -> Trails:
    """Return the trails around a frame; each block is read once and cached until `forget`.

    Only the blocks near the frame are read, so that long takes and distant keys cost nothing.
    """
    ends = np.array([action.curve_frame_range for action, _ in played.sources])
    first, last = round(ends[:, 0].min()), round(ends[:, 1].max())
    start = min(max(round(frame), first), last) // BLOCK_FRAMES * BLOCK_FRAMES
    frames = range(max(start - reach, first), min(start + BLOCK_FRAMES + reach, last) + 1)
    markers = tuple(
        (marker.session_uid, action.session_uid, slot.handle)
        for marker, (action, slot) in zip(*played, strict=True)
    )
    key = (markers, frames)
    if key not in _cache:
        while len(_cache) >= MAX_CACHED:
            del _cache[next(iter(_cache))]
        _cache[key] = read_trails(played, frames)
    return _cache[key]


def read_trails(played: ComparedMarkers, within: range) -> Trails:
    """Read the location keys of markers at integer frames of their actions."""
    frames = np.arange(within.start, within.stop, dtype=np.float64)
    positions = []
    for marker, source in zip(*played, strict=True):
        curves = curves_of(animated_curves(*source), PATH, 3)
        values = sampled(curves, marker.location, frames)
        values[gaps_of(curves, frames)] = np.nan
        positions.append(values)
    return Trails(within.start, np.stack(positions, axis=1).astype(np.float32))


def forget() -> None:
    """Clear the cache, so that the next drawing reads again."""
    _cache.clear()
