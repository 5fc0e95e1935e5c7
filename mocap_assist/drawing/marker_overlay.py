"""Places and trails of a take's markers, raw and clean, as plain arrays."""

from dataclasses import dataclass
from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ..actions.bone_channels import animated_curves, curves_of, gaps_of, sampled
from ..actions.markers import PATH, markers_of, source_of
from ..blender.compat import Source
from ..scene import history
from ..scene.units import unit_of

Array = NDArray[np.float64]

TRAIL = 0.2
"""Seconds that a trail shows before and after the present frame."""
SIZE = 0.006
"""Metres from the middle of a marker's cross to its ends."""
BLOCK = 1000
"""Frames that are read at a time."""
N_KEPT = 8
"""Blocks that are kept: of 41 markers, 500 kB each."""


@dataclass(frozen=True, eq=False)
class Trails:
    """Markers over whole frames of a take; NaN where one was not recorded."""

    start: int
    """Scene frame of the first row."""
    places: NDArray[np.float32]
    """Shape (n_frames, n_markers, 3), each in its marker's own space, in Blender's unit."""

    def segments(self, frame: float, reach: int, size: float, spaces: Array) -> Array:
        """Return a cross for each marker at a frame, or the nearest one, and its trail.

        Parameters
        ----------
        frame : float
        reach : int
            Frames of the trail to either side.
        size : float
            Of half a cross, in Blender's unit.
        spaces : shape (n_markers, 4, 4)
            From each marker's own space to the world.

        Returns
        -------
        shape (n_lines, 2, 3), in the world, no NaN
        """
        row = min(max(round(frame) - self.start, 0), len(self.places) - 1)
        first = max(row - reach, 0)
        near = np.einsum(
            "mij,fmj->fmi", spaces[:, :3, :3], self.places[first : row + reach + 1]
        )
        near += spaces[:, :3, 3]
        trails = np.stack([near[:-1], near[1:]], axis=2).reshape(-1, 2, 3)
        arms = size * np.stack([-np.eye(3), np.eye(3)], axis=1)
        crosses = (near[row - first][:, None, None] + arms).reshape(-1, 2, 3)
        lines: Array = np.concatenate([crosses, trails])
        known: NDArray[np.bool_] = np.isfinite(lines).all(axis=(1, 2))
        return lines[known]


class Played(NamedTuple):
    """Markers, and what they play in one of the two takes to compare."""

    markers: tuple[bpy.types.Object, ...]
    sources: tuple[Source, ...]


_kept: dict[tuple[tuple[tuple[int, int, int], ...], range], Trails] = {}


def raw_and_clean(holder: bpy.types.Object) -> tuple[Played, Played]:
    """Return the markers below an object with what was recorded, and with what was made of it.

    That is the result which a marker plays or, where it plays the recorded action, the last one
    in the file that was made from it. A marker without a result is not in the second.
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
    return _together(raw), _together(clean)


def _newest_results() -> dict[bpy.types.Action, bpy.types.Action]:
    """Return the last result in the file by the action that was recorded."""
    made_last = sorted(bpy.data.actions, key=lambda each: each.session_uid)
    results = [(each.get(history.SOURCE), each) for each in made_last]
    return {raw: each for raw, each in results if isinstance(raw, bpy.types.Action)}


def _same_slot(action: bpy.types.Action | None, like: Source) -> Source | None:
    slots = () if action is None else action.slots
    same = next((slot for slot in slots if slot.handle == like[1].handle), None)
    return None if same is None else (action, same)


def _together(pairs: list[tuple[bpy.types.Object, Source]]) -> Played:
    return Played(tuple(marker for marker, _ in pairs), tuple(source for _, source in pairs))


def lines_at(played: Played, scene: bpy.types.Scene) -> Array:
    """Return what to draw of markers at the scene's frame, in the world: (n_lines, 2, 3)."""
    if not played.markers:
        return np.zeros((0, 2, 3))
    spaces = [each.matrix_world @ each.matrix_basis.inverted_safe() for each in played.markers]
    reach = round(TRAIL * scene.render.fps / scene.render.fps_base)
    frame = scene.frame_current_final
    size = SIZE / unit_of(scene)
    return trails_at(played, frame, reach).segments(frame, reach, size, np.array(spaces))


def trails_at(played: Played, frame: float, reach: int) -> Trails:
    """Return the trails around a frame; a block of frames is read once, and kept till `forget`.

    However long a take is, or how far out one of its keys: only what is near is read.
    """
    ends = np.array([action.curve_frame_range for action, _ in played.sources])
    first, last = round(ends[:, 0].min()), round(ends[:, 1].max())
    start = min(max(round(frame), first), last) // BLOCK * BLOCK
    frames = range(max(start - reach, first), min(start + BLOCK + reach, last) + 1)
    markers = tuple(
        (marker.session_uid, action.session_uid, slot.handle)
        for marker, (action, slot) in zip(*played, strict=True)
    )
    key = (markers, frames)
    if key not in _kept:
        while len(_kept) >= N_KEPT:
            del _kept[next(iter(_kept))]
        _kept[key] = read_trails(played, frames)
    return _kept[key]


def read_trails(played: Played, within: range) -> Trails:
    """Read the location keys of markers at these whole frames of what they play."""
    frames = np.arange(within.start, within.stop, dtype=np.float64)
    places = []
    for marker, source in zip(*played, strict=True):
        curves = curves_of(animated_curves(*source), PATH, 3)
        place = sampled(curves, marker.location, frames)
        place[gaps_of(curves, frames)] = np.nan
        places.append(place)
    return Trails(within.start, np.stack(places, axis=1).astype(np.float32))


def forget() -> None:
    """Read everything anew when it is drawn next."""
    _kept.clear()
