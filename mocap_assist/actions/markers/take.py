"""Convert the markers of a take to tracks, and back."""

from collections.abc import Collection, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, replace
from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ....solvers.arrays import Array
from ....solvers.errors import InvalidMotionError
from ....solvers.motion import Motion, Tracks
from ...blender.block_references import BlockReference, SourceReference, kept_when_complete
from ...blender.compat import Source
from ...blender.time_slices import Sliced, Steps, should_yield
from ...scene import history
from ...scene.rig import Placement, check_finite, placement_of
from ...scene.units import unit_of
from ..armature_write import copy_of, same_slot
from ..bone_channels import Curves, animated_curves, curves_of, gaps_of, sampled
from ..curves import write_values
from ..frames import FrameRange, Grid, key_grid, range_bounds
from ..sensor_notes import CONFIDENCE
from .holders import PATH, markers_of, point_names, source_of


@dataclass(frozen=True, eq=False)
class MarkerTake:
    """Data of a take in the form that solvers use."""

    markers: tuple[bpy.types.Object, ...]
    sources: tuple[Source, ...]
    """Action and slot of each marker."""
    grid: Grid
    tracks: Tracks
    """In the world, meters; NaN where a marker has no keys though it has them all around."""
    spaces: tuple[Placement, ...]
    """World placement of each marker's own space."""

    @property
    def frames(self) -> Array:
        """Scene frames, shape (n_frames,)."""
        return self.grid.frames

    @property
    def recordings(self) -> tuple[Tracks, ...]:
        """Recordings to solve."""
        return (self.tracks,)

    def with_recordings(self, recordings: tuple[Motion | Tracks, ...]) -> "MarkerTake":
        """Return the take with its tracks replaced."""
        (tracks,) = (each for each in recordings if isinstance(each, Tracks))
        return replace(self, tracks=tracks)


@Sliced
def read_markers(
    holder: bpy.types.Object,
    scene: bpy.types.Scene,
    choice: FrameRange = FrameRange.ACTION,
    *,
    recorded: bool = False,
    grid: Grid | None = None,
) -> Steps[MarkerTake]:
    """Read the location keys of all markers below an object.

    Parameters
    ----------
    holder : the object above the markers; its own motion is not looked at
    scene : bpy.types.Scene
        Its frame rate, ranges and unit.
    choice : FrameRange
    recorded : bool
        What was recorded, rather than the result that is played.
    grid : Grid
        Frames to read instead of those of the keys within `choice`.

    Raises
    ------
    InvalidMotionError
        There are no markers or keys, a marker's space is scaled unevenly, or something was
        deleted between two time slices.
    """
    lasting = BlockReference.of(holder), BlockReference.of(scene)
    markers = _Markers.of(holder, recorded)
    if grid is None:
        keyed = [
            curve for each in markers.curves for curve in curves_of(each, PATH, 3).values()
        ]
        bounds = range_bounds(choice, scene, keyed, markers.objects[0])
        grid = key_grid(keyed, bounds, recorded=True)
    _check_captured(markers)
    bpy.context.view_layer.update()
    spaces = tuple(_space(marker, unit_of(scene)) for marker in markers.objects)
    positions, confidence = [], []
    for number, space in enumerate(spaces):
        marker, curves = markers.objects[number], markers.curves[number]
        positions.append(space.points(_locations(marker, curves, grid)))
        confidence.append(_confidence(curves, grid.frames))
        if should_yield():
            yield number / len(spaces)
            holder, scene = (each.find() for each in lasting)
            markers = markers.found_again(holder, recorded)
    rate = scene.render.fps / scene.render.fps_base / grid.step
    names = point_names(markers.objects)
    tracks = Tracks(names, np.stack(positions, axis=1), rate, _join_confidence(confidence))
    return MarkerTake(markers.objects, markers.sources, grid, tracks, spaces)


class _Markers(NamedTuple):
    """The markers below an object, and what animates each."""

    objects: tuple[bpy.types.Object, ...]
    sources: tuple[Source, ...]
    curves: tuple[Curves, ...]

    @classmethod
    def of(cls, holder: bpy.types.Object, recorded: bool) -> "_Markers":
        markers = markers_of(holder)
        if not markers:
            raise InvalidMotionError(f"{holder.name} has no empties with keyed locations.")
        sources = tuple(_source(marker, recorded) for marker in markers)
        return cls(markers, sources, tuple(animated_curves(*source) for source in sources))

    def found_again(self, holder: bpy.types.Object, recorded: bool) -> "_Markers":
        """Return the same markers, with their keys, after a time slice of Blender."""
        found = _Markers.of(holder, recorded)
        if len(found.objects) != len(self.objects):
            raise InvalidMotionError(
                f"Markers of {holder.name} were added or deleted while they were read. Press"
                " the button again."
            )
        for before, curves in zip(self.curves, found.curves, strict=True):
            for name, channel in curves.items():
                channel.with_keys_of(before.get(name))
        return found


@Sliced
def write_markers(
    take: MarkerTake, chosen: Collection[str], key_types: Mapping[str, NDArray[np.uint8]]
) -> Steps[tuple[tuple[bpy.types.Object, Source, Source], ...]]:
    """Copy the actions and replace the location keys of the chosen markers.

    Parameters
    ----------
    take : MarkerTake
        The result, over the frames to replace; its `sources` are what is copied.
    chosen : names of the points to change
        All else is copied bit for bit.
    key_types : per point name, shape (n_frames,)
        Blender's type of each key.

    Returns
    -------
    tuple of (marker, what was copied, what it should play now)
    """
    markers = [BlockReference.of(marker) for marker in take.markers]
    sources = [SourceReference.of(source) for source in take.sources]
    copies: dict[BlockReference, BlockReference] = {}
    written = []
    with ExitStack() as cleanup:
        for point, (marker, source) in enumerate(zip(markers, sources, strict=True)):
            action, slot = source.find()
            if source.action not in copies:
                copy = copy_of(action)
                cleanup.enter_context(kept_when_complete(copy))
                copies[source.action] = BlockReference.of(copy)
            copy = copies[source.action].find()
            made = copy, same_slot(copy, slot)
            _write_marker(take, point, made, chosen, key_types)
            written.append((marker, source, SourceReference.of(made)))
            if should_yield():
                yield point / len(markers)
        return tuple(
            (marker.find(), source.find(), made.find()) for marker, source, made in written
        )


def _write_marker(
    take: MarkerTake,
    point: int,
    made: Source,
    chosen: Collection[str],
    key_types: Mapping[str, NDArray[np.uint8]],
) -> None:
    name = take.tracks.names[point]
    if name not in chosen:
        return
    positions = take.spaces[point].points_back(take.tracks.positions[:, point])
    for index, channel in curves_of(animated_curves(*made), PATH, 3).items():
        write_values(channel.curve, take.frames, positions[:, index], key_types.get(name))


def _source(marker: bpy.types.Object, recorded: bool) -> Source:
    played = source_of(marker)
    raw = history.raw_of(*played) if recorded else None
    return raw or played


def _check_captured(markers: _Markers) -> None:
    """Raise InvalidMotionError where a marker has keys, but none with a value."""
    empty = []
    for marker, curves in zip(markers.objects, markers.curves, strict=True):
        keyed = [each.keys[:, 1] for each in curves_of(curves, PATH, 3).values()]
        if any(map(len, keyed)) and not any(np.isfinite(each).any() for each in keyed):
            empty.append(marker.name)
    if empty:
        raise InvalidMotionError(
            f"All keys of {', '.join(empty)} are NaN: nothing was captured. Delete such"
            " markers, or import the take again."
        )


def _space(marker: bpy.types.Object, meters: float) -> Placement:
    """Return the world placement of the space of the marker's location."""
    check_finite(marker.matrix_basis, marker.name)
    if not marker.matrix_basis.determinant():
        raise InvalidMotionError(f"{marker.name} has scale 0. Give it a scale above 0.")
    around = marker.matrix_world @ marker.matrix_basis.inverted()
    rotation, origin, scale = placement_of(around, marker.name)
    return Placement(rotation[None], origin[None], scale).in_unit(meters)


def _locations(marker: bpy.types.Object, curves: Curves, grid: Grid) -> Array:
    found = curves_of(curves, PATH, 3)
    locations = sampled(found, marker.location, grid.frames)
    locations[gaps_of(found, grid.frames, grid.step)] = np.nan
    return locations


def _confidence(curves: Curves, frames: Array) -> Array | None:
    """Return the sensor's confidence in a point, (n_frames,), or None."""
    curve = curves.get((f'["{CONFIDENCE}"]', 0))
    return None if curve is None else np.clip(curve.values(frames), 0.0, 1.0)


def _join_confidence(confidence: list[Array | None]) -> Array | None:
    """Return the sensor's confidence in all points, (n_frames, n_points), or None."""
    known = [each for each in confidence if each is not None]
    if not known:
        return None
    full_confidence = np.ones(len(known[0]))
    return np.stack([full_confidence if each is None else each for each in confidence], axis=1)
