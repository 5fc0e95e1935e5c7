"""Read the CSV export of OptiTrack Motive: markers, rigid bodies and skeletons."""

import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import Motion, Tracks
from ...progress import Progress, Remark, unwatched, within
from ...rotations import multiply, normalize, quaternion_from_euler, rotate, unroll
from ..containers import LineReader, stream_cells
from ..conventions import (
    Bodies,
    bodies_of_markers,
    check_scale,
    meters_from_unit_name,
    observed_body,
    stand_markers,
)
from ..skeleton_files import recording_from_segments
from .marker_rows import at_constant_rate, mark_missing
from .motive_header import (
    AXES,
    BONE,
    MARKER,
    RIGID_BODY,
    MotiveHeader,
    MotiveItem,
    read_motive_header,
)

HEAD = re.compile(rb'(?i)[\s"]*Format Version["\s]*[,;\t]')
EXPECTED_MARKERS = ("rigid body marker", "bone marker", "marker set marker")
"""Types of the places that Motive computes for the markers of an asset."""
GLOBAL, LOCAL = "global", "local"
EULER_ORDER = re.compile(r"(?!.*(.).*\1)[xyz]{3}", re.IGNORECASE)
QUATERNION = "quaternion"
ROOT = "Hip"
"""Name of a root that is called as its actor."""


def is_motive_csv(head: bytes) -> bool:
    """Return whether a file begins as Motive's tables do."""
    return HEAD.match(head) is not None and b"ake" in head[:4096]


def open_motive_csv(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[Motion | Tracks]:
    """List the bodies of a CSV of OptiTrack Motive; read in meters, Z up, blanks are missing.

    Each skeleton is a body, and its bones become a motion. Their hierarchy is the row `Parent`
    or, without it, follows from Motive's names of bones (`recording_from_segments`). Without
    skeletons, markers and the origins of rigid bodies become points, and their subjects are
    bodies. Markers are measured ones, or the expected ones if there are no others. Motive has
    Y up unless the export turned its axes, which the body shows. Frames count from the first
    of the export, and skipped ones are gaps.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: the length units in the first line.
    progress : Progress
        Receives a message about what is left out.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, states no unit or rotation type, or has no positions.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    reader = LineReader(path)
    header = read_motive_header(reader, path)
    unit = scale or meters_from_unit_name(header.fields.get("length units", ""))
    if unit is None:
        raise InvalidFileError(
            f"{path} does not state a known length unit. Give the unit, or export it again."
        )
    rows = stream_cells(
        reader, header.separator, header.width, path, within(progress, 0.0, 0.7)
    )
    if not len(rows):
        raise InvalidFileError(f"{path} has a header but no frames. Export it again.")
    bones = [item for item in header.items if item.kind == BONE and item.rotation]
    skeletons: dict[str, list[MotiveItem]] = {}
    for bone in bones:
        skeletons.setdefault(_actor_and_bone(bone.name)[0], []).append(bone)
    if not skeletons:
        return _points(header, rows, unit, path, progress)
    if len(header.items) > len(bones):
        progress(
            0.8, Remark("Markers and rigid bodies are left out, since the file has a skeleton")
        )
    duration_s = len(rows) / (_stated_rate(header) or 1.0)
    listed = tuple(
        observed_body(name or str(number), _observed_rows(part, rows), len(rows), duration_s)
        for number, (name, part) in enumerate(skeletons.items(), start=1)
    )
    parts = list(skeletons.values())

    def read(index: int, progress: Progress) -> Motion | Tracks:
        return _skeleton(header, parts[index], rows, unit, path, progress)

    return Bodies(str(path), listed, read)


def _actor_and_bone(name: str) -> tuple[str, str]:
    """Split `Anna:LHand`, or `Anna_LHand` of older versions; the root may be `Anna:Anna`."""
    actor, mark, bone = name.rpartition(":")
    if not mark:
        actor, _, bone = name.rpartition("_")
    return actor, ROOT if bone == actor else bone


def _observed_rows(bones: list[MotiveItem], rows: Array) -> NDArray[np.intp]:
    """Return the rows with the first bone of a skeleton."""
    return np.flatnonzero(np.isfinite(rows[:, bones[0].position["X"]]))


def _points(
    header: MotiveHeader, rows: Array, unit: float, path: Path | str, progress: Progress
) -> Bodies[Tracks]:
    """List the subjects of the markers and the origins of rigid bodies."""
    kinds = {item.kind for item in header.items}
    kept = {MARKER, RIGID_BODY} if MARKER in kinds else {*EXPECTED_MARKERS, RIGID_BODY, BONE}
    items = [item for item in header.items if item.kind in kept]
    if not items:
        raise InvalidFileError(
            f"{path} has no positions of markers, rigid bodies or bones. Export it with them."
        )
    if RIGID_BODY in kinds:
        progress(0.8, Remark("The origins of rigid bodies are read, not their rotations"))
    points = _positions(items, rows)
    mark_missing(points, path)
    points, rate = _resampled(header, points, rows, path)
    progress(1.0, "Reading")
    labels = [item.name for item in items]
    return bodies_of_markers(
        path, stand_markers(labels, points * unit, rate, unit, "+Y"), labels
    )


def _skeleton(
    header: MotiveHeader,
    bones: list[MotiveItem],
    rows: Array,
    unit: float,
    path: Path | str,
    progress: Progress,
) -> Motion | Tracks:
    points = _positions(bones, rows)
    rotations = _rotations(header, bones, rows, path)
    missing = ~np.isfinite(points).all(axis=-1) | ~np.isfinite(rotations).all(axis=-1)
    points[missing], rotations[missing] = np.nan, np.nan
    if missing.all():
        raise InvalidFileError(f"{path} has no bone that is observed in any frame.")
    together = np.concatenate([points * unit, unroll(rotations)], axis=-1)
    together, rate = _resampled(header, together, rows, path)
    points, rotations = together[..., :3], normalize(together[..., 3:])
    names = [_actor_and_bone(bone.name)[1] for bone in bones]
    parents = None
    if header.has_parents:
        known = {bone.name: name for bone, name in zip(bones, names, strict=True)}
        known |= {name: name for name in names}
        parents = {
            name: known.get(bone.parent, known.get(_actor_and_bone(bone.parent)[1], ""))
            for bone, name in zip(bones, names, strict=True)
        }
    if header.fields.get("coordinate space", GLOBAL).lower() == LOCAL:
        points, rotations = _to_world(names, points, rotations, parents, path)
    return recording_from_segments(
        names, points, rotations, rate, progress, parents=parents, default_up="+Y"
    )


def _to_world(
    names: list[str],
    points: Array,
    rotations: Array,
    parents: Mapping[str, str] | None,
    path: Path | str,
) -> tuple[Array, Array]:
    """Return positions and rotations in the world of bones that are relative to parents."""
    if parents is None:
        raise InvalidFileError(
            f"{path} has bones in the space of their parents, but no row of parents. Export it"
            " in the global coordinate space."
        )
    world_points, world_rotations = points.copy(), rotations.copy()
    done: set[str] = set()
    for _ in names:
        for joint, name in enumerate(names):
            parent = parents[name]
            if name in done or (parent and parent not in done):
                continue
            if parent:
                above = names.index(parent)
                world_rotation = world_rotations[:, above]
                world_rotations[:, joint] = multiply(world_rotation, rotations[:, joint])
                world_points[:, joint] = world_points[:, above] + rotate(
                    world_rotation, points[:, joint]
                )
            done.add(name)
    return world_points, world_rotations


def _positions(items: list[MotiveItem], rows: Array) -> Array:
    """Return positions in the file's unit, shape (n_rows, n_items, 3)."""
    return rows[:, [[item.position[axis] for axis in AXES[:3]] for item in items]]


def _rotations(
    header: MotiveHeader, bones: list[MotiveItem], rows: Array, path: Path | str
) -> Array:
    """Return quaternions w x y z, shape (n_rows, n_bones, 4)."""
    kind = header.fields.get("rotation type", "").strip().lower()
    n_axes = 4 if kind == QUATERNION else 3
    order = "WXYZ" if n_axes == 4 else kind.upper()
    if n_axes == 3 and not EULER_ORDER.fullmatch(kind):
        raise InvalidFileError(
            f"{path} does not state a known rotation type. Export it with quaternions."
        )
    if any(axis not in bone.rotation for bone in bones for axis in order):
        raise InvalidFileError(
            f"{path} has no columns for the rotation {kind} of every bone. Export it again."
        )
    numbers = rows[:, [[bone.rotation[axis] for axis in order] for bone in bones]]
    if n_axes == 4:
        return normalize(numbers)
    return quaternion_from_euler(np.radians(numbers), order)


def _resampled(
    header: MotiveHeader, values: Array, rows: Array, path: Path | str
) -> tuple[Array, float]:
    return at_constant_rate(values, rows[:, 0], rows[:, 1], _stated_rate(header), path)


def _stated_rate(header: MotiveHeader) -> float | None:
    """Return frames per second as the first line states them."""
    rates = (
        _number(header.fields.get(key, ""))
        for key in ("export frame rate", "capture frame rate")
    )
    return next((rate for rate in rates if rate > 0.0), None)


def _number(text: str) -> float:
    try:
        return float(text.replace(",", "."))
    except ValueError:
        return 0.0
