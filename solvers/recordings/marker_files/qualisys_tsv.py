"""Read the TSV exports of Qualisys QTM: markers, rigid bodies and skeletons."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import Motion, Tracks
from ...progress import Progress, Remark, unwatched, within
from ...rotations import normalize, unroll
from ..containers import LineReader, decode_text, split_cells, stream_cells
from ..conventions import (
    MILLIMETER,
    Bodies,
    bodies_of_markers,
    check_scale,
    point_names,
    stand_markers,
)
from ..skeleton_files import recording_from_segments
from .marker_rows import at_constant_rate, mark_missing

HEAD = re.compile(rb'[\s"]*(FILE_VERSION|NO_OF_FRAMES)\b')
KEY = re.compile(r"[A-Z][A-Z_]+")
TAB = b"\t"
MAX_HEADER_LINES = 2000
"""Maximum lines of the header; each event has one."""
MARKERS, BODIES, REFERENCE = "MARKER_NAMES", "BODY_NAMES", "REFERENCE"
COLUMNS_OF_BODY = 16
"""Position, three angles, residual and a matrix; some versions write fewer of them."""
COLUMNS_OF_SEGMENT = 8
"""A blank one below the name, position, and quaternion x y z w."""
LOCAL = "LOCAL"
TITLES = {"frame", "time"}


class _QualisysHeader(NamedTuple):
    """Contents of the lines above the frames."""

    fields: dict[str, list[str]]
    titles: list[str]
    """Names of the columns; empty without such a line."""


def is_qualisys_tsv(head: bytes) -> bool:
    """Return whether a file begins with the header of QTM."""
    return HEAD.match(head) is not None


def open_qualisys_tsv(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[Motion | Tracks]:
    """List the bodies of a TSV of Qualisys QTM; read in meters, Z up, missing values are NaN.

    A skeleton in global coordinates becomes a motion (`recording_from_segments`); markers, and
    the origins of rigid bodies, become points. A point is missing if a cell is blank or not a
    number, or if it is exactly at the origin. QTM has Z up; eight or more points of a file
    with Y up are recognized by the body (`estimate_axes_of_points`).

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: millimeters.
    progress : Progress
        Receives a message about what is left out.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, has 2D data or no names, or a skeleton's segments are
        relative to their parents.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    reader = LineReader(path)
    header = _read_header(reader, path)
    unit = MILLIMETER if scale is None else scale
    first = (reader.peek() or [b""])[0]
    width = max(len(header.titles), len(split_cells(first.rstrip(), TAB)))
    rows = stream_cells(
        reader, TAB, width, path, within(progress, 0.0, 0.7), keep_blank=not header.titles
    )
    if not len(rows):
        raise InvalidFileError(f"{path} has a header but no frames. Export it again.")
    if REFERENCE in header.fields and MARKERS not in header.fields:
        skeleton = _skeleton(header, rows, unit, path, progress)
        return Bodies(str(path), (), lambda index, progress: skeleton)
    return _points(header, rows, unit, path, progress)


def _points(
    header: _QualisysHeader, rows: Array, unit: float, path: Path | str, progress: Progress
) -> Bodies[Tracks]:
    """List the subjects of the markers, or the origins of rigid bodies."""
    key = MARKERS if MARKERS in header.fields else BODIES
    labels = header.fields.get(key, [])
    while labels and not labels[-1]:
        labels = labels[:-1]
    if not labels:
        raise InvalidFileError(
            f"{path} has no names of markers, bodies or segments in its header. Export 3D data"
            " with the TSV header."
        )
    n_stamps, step = _columns_per_item(header, rows.shape[1], len(labels), key)
    if not step:
        raise InvalidFileError(
            f"{path} has {rows.shape[1]} columns, which do not fit its {len(labels)} names."
            " Export it again."
        )
    if key == BODIES:
        progress(0.8, Remark("The origins of rigid bodies are read, not their rotations"))
    first = n_stamps + step * np.arange(len(labels))
    points = rows[:, first[:, None] + np.arange(3)]
    mark_missing(points, path)
    points, rate = _resampled(header, points, rows[:, :n_stamps], path)
    progress(1.0, "Reading")
    tracks = stand_markers(labels, points * unit, rate, unit, "+Z")
    return bodies_of_markers(path, tracks, labels)


def _columns_per_item(
    header: _QualisysHeader, width: int, n_items: int, key: str
) -> tuple[int, int]:
    """Return the number of columns of stamps, and of each item; 0 if none fits."""
    titled = [title.lower() for title in header.titles[:2] if title.lower() in TITLES]
    for n_stamps in (len(titled),) if header.titles else (0, 2, 1):
        step, rest = divmod(width - n_stamps, n_items)
        if not rest and (step == 3 if key == MARKERS else 3 <= step <= COLUMNS_OF_BODY):
            return n_stamps, step
    return 0, 0


def _skeleton(
    header: _QualisysHeader, rows: Array, unit: float, path: Path | str, progress: Progress
) -> Motion | Tracks:
    if header.fields[REFERENCE][:1] == [LOCAL]:
        raise InvalidFileError(
            f"{path} has segments relative to their parents, which it does not name. Export"
            " the skeleton from QTM in global coordinates, or as FBX."
        )
    titles = header.titles
    first = [
        at
        for at in range(len(titles) - COLUMNS_OF_SEGMENT + 1)
        if [title.upper() for title in titles[at + 1 : at + 5]] == ["X", "Y", "Z", "QX"]
    ]
    if not first:
        raise InvalidFileError(
            f"{path} has no columns X, Y, Z and QX of a segment. Export the skeleton again."
        )
    columns = np.array(first)[:, None]
    points = rows[:, columns + np.arange(1, 4)]
    rotations = rows[:, columns + np.array([7, 4, 5, 6])]
    mark_missing(points, path)
    points[~np.isfinite(rotations).all(axis=-1)] = np.nan
    together = np.concatenate([points * unit, unroll(normalize(rotations))], axis=-1)
    stamps = rows[:, : sum(title.lower() in TITLES for title in titles[:2])]
    together, rate = _resampled(header, together, stamps, path)
    names = point_names([titles[at] for at in first])
    return recording_from_segments(
        names, together[..., :3], normalize(together[..., 3:]), rate, progress
    )


def _resampled(
    header: _QualisysHeader, values: Array, stamps: Array, path: Path | str
) -> tuple[Array, float]:
    """Resample by the columns Frame and Time, if there are any."""
    unknown = np.full(len(values), np.nan)
    frames = stamps[:, 0] if stamps.shape[1] else unknown
    times = stamps[:, 1] if stamps.shape[1] > 1 else unknown
    try:
        rate = float(header.fields.get("FREQUENCY", [""])[0].replace(",", "."))
    except ValueError:  # EXT: an external clock
        rate = 0.0
    return at_constant_rate(values, frames, times, rate if rate > 0.0 else None, path)


def _read_header(reader: LineReader, path: Path | str) -> _QualisysHeader:
    """Read up to the first line that begins with neither a key nor the name of a column."""
    fields: dict[str, list[str]] = {}
    titles: list[str] = []
    while (line := reader.peek()) and reader.n_taken < MAX_HEADER_LINES:
        cells = [decode_text(cell) for cell in split_cells(line[0], TAB)]
        if _is_line_of_titles(cells):
            titles = cells[: 1 + max(at for at, cell in enumerate(cells) if cell)]
        elif KEY.fullmatch(cells[0]):
            fields.setdefault(cells[0], cells[1:] or [""])
        elif any(cells):
            break
        reader.take()
    if fields.get("DATA_INCLUDED", [""])[0].upper() == "2D":
        raise InvalidFileError(
            f"{path} has the 2D positions of markers in each camera. Export 3D data from QTM."
        )
    return _QualisysHeader(fields, titles)


def _is_line_of_titles(cells: Sequence[str]) -> bool:
    """Return whether cells name columns, such as `Frame`, `Time`, `LFHD X`."""
    return cells[0].lower() in TITLES or cells[0].endswith((" X", " x"))
