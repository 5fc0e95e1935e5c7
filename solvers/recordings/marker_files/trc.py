"""Read TRC files: marker tracks of Motion Analysis systems and of OpenSim."""

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...motion import Tracks
from ...progress import Progress, unwatched, within
from ...rotations import FULL_TURN_RAD
from ..containers import ROWS_AT_ONCE, LineReader, decode_text, read_number, shown
from ..conventions import (
    Bodies,
    bodies_of_markers,
    check_scale,
    estimate_axes_of_points,
    guess_unit_of_points,
    meters_from_unit_name,
    point_names,
    points_z_up,
)
from .marker_rows import MAX_RATE_HZ, MAX_VALUE, MIN_RATE_HZ, at_constant_rate, mark_missing

MAX_HEADER_LINES = 30
"""Maximum length of the header."""
TITLE_OF_TIMES = r'(?i)[\s"]*frame\s*#?"?\s*"?(time\w*)?[ "]*\t?'
COMMA_TITLE = r'(?i)"?frame\s*#?"?,'
TITLE = rb'[\s",]*[A-Za-z]'
"""Start of the line of axis titles, X1, Y1, Z1 and so on."""
MAX_BLANK_RATIO = 10
MAX_UNCHECKED_CELLS = 1_000_000


class _TrcHeader(NamedTuple):
    """Contents of the header."""

    rate: float | None
    unit: str
    up: str
    labels: list[str]
    n_lines: int
    separator: bytes


def read_trc(
    path: Path | str,
    *,
    scale: float | None = None,
    body: str | None = None,
    progress: Progress = unwatched,
) -> Tracks:
    """Read the markers of a TRC file, in meters, Z up; missing markers are NaN.

    A marker is missing if a coordinate is blank or not a number, or if it is exactly at the
    origin, as some programs write it. Markers and frames are counted, and their numbers in the
    header are ignored; columns after the last name are unnamed markers.

    The frame rate is the DataRate of the header if it agrees with the times of the frames,
    otherwise the rate of the times. Times are seconds, or milliseconds if only these agree.
    Skipped frames are gaps, and uneven times are resampled (`ConstantRate`). Up is read from
    the first line, from a cell such as `Y up`, which our own files have. Without it, up is
    estimated to be Y or Z from the points of a body (`points_z_up`); with too few points for a
    body it is Y, as the format defines. The heading of the actor is unchanged.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: the Units of the header or, without them, the unit of meters, centimeters and
        millimeters that gives a person's size.
    body : str, optional
        Name or number of a subject (`Bodies.choose`); by default the person in most frames, or
        all markers of one person and its props.
    progress : Progress

    Returns
    -------
    Tracks
        Names are unique (`LFHD_2`), and without the prefix of the actor (`Anna:LFHD`) if there
        is only one, or one is read; unnamed markers are called `point_<number>`.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, not TRC, has no markers, or holds angles.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    return open_trc(path, scale=scale, progress=progress).read_one(body, progress)


def open_trc(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[Tracks]:
    """List the subjects of a file that `read_trc` reads."""
    check_scale(scale)
    reader = LineReader(path)
    header = _read_header(reader.peek(MAX_HEADER_LINES), path)
    reader.take(header.n_lines)
    rows = _read_rows(reader, header.separator, path, within(progress, 0.0, 0.8))
    frames, times, points = _columns_from_rows(rows, len(header.labels), path)
    mark_missing(points, path)
    unit = _unit(header, points, path, progress) if scale is None else scale
    points *= unit
    points, rate = at_constant_rate(points, frames, times, header.rate, path)
    labels = header.labels + [""] * (points.shape[1] - len(header.labels))
    axes = estimate_axes_of_points(points, header.up, unit, "+Y", labels)
    positions = points_z_up(points, axes.up)
    tracks = Tracks(point_names(labels), positions, rate, conventions=axes)
    progress(1.0, "Reading")
    return bodies_of_markers(path, tracks, labels)


def _read_header(lines: list[bytes], path: Path | str) -> _TrcHeader:
    """Read the header up to the names, which are in the line that begins with `Frame#`."""
    texts = [decode_text(line) for line in lines]
    commas = any(re.match(COMMA_TITLE, text) for text in texts)
    if commas:
        texts = [text.rstrip(",").replace(",", "\t") for text in texts]
    name_line = next(
        (index for index, text in enumerate(texts) if re.match(r'(?i)[\s"]*frame', text)), None
    )
    if name_line is None:
        raise InvalidFileError(
            f"{path} has no line that begins with Frame# and lists the markers. It is not a"
            " TRC file, or is damaged; export it again."
        )
    keys = next(
        (index for index, text in enumerate(texts[:name_line]) if "datarate" in text.lower()),
        None,
    )
    fields = {} if keys is None else _parse_header_fields(texts[keys], texts[keys + 1])
    up = re.search(r"(?i)\t\s*([+-]?[XYZ]) up\s*(\t|$)", texts[0])
    rate = None
    if word := fields.get("datarate"):
        rate = read_number(word.encode(), f"{path}, line {(keys or 0) + 2}, DataRate")
    return _TrcHeader(
        rate=rate if rate is not None and MIN_RATE_HZ < rate < MAX_RATE_HZ else None,
        unit=fields.get("units", "").partition(" ")[0],
        up=up[1].upper() if up else "",
        labels=_labels(texts[name_line]),
        n_lines=name_line + 1,
        separator=b"," if commas else b"\t",
    )


def _cells(text: str) -> list[str]:
    """Split a line at tabs, or at spaces if it has no tabs."""
    cells = text.rstrip().split("\t") if "\t" in text.rstrip() else text.split()
    return [cell.strip(' "') for cell in cells]


def _parse_header_fields(keys: str, values: str) -> dict[str, str]:
    """Combine the second and third line; some programs put two tabs between values."""
    name_line, given = _cells(keys.lower()), _cells(values)
    filled = [[cell for cell in cells if cell] for cells in (name_line, given)]
    if len(filled[0]) == len(filled[1]):
        name_line, given = filled
    return dict(zip(name_line, given, strict=False))


def _labels(text: str) -> list[str]:
    """Return the names: each above the first of its three columns, or in adjacent columns.

    Some programs write a space instead of a tab between `Time` and the first name.
    """
    title = re.match(TITLE_OF_TIMES, text)
    rest = text[title.end() :] if title else ""
    names = _cells(f"-\t{rest}")[1:] if "\t" in text.rstrip() else rest.split()
    filled = [column for column, name in enumerate(names) if name]
    if all(column % 3 == 0 for column in filled):
        return names[::3]
    return [names[column] for column in filled]


class _Rows(NamedTuple):
    """Rows of different lengths, concatenated."""

    numbers: NDArray[np.float64]
    lengths: NDArray[np.intp]

    def fill(self, table: NDArray[np.float64]) -> None:
        """Write each row to the first columns of a table, shape (n_rows, width)."""
        length = int(self.lengths[0])
        if length <= table.shape[1] and (self.lengths == length).all():
            table[:, :length] = self.numbers.reshape(-1, length)
            return
        stops = np.cumsum(self.lengths)
        for row, stop, length in zip(table, stops, self.lengths, strict=True):
            row[:length] = self.numbers[stop - length : stop][: len(row)]


def _read_rows(
    reader: LineReader, separator: bytes, path: Path | str, progress: Progress
) -> list[_Rows]:
    """Return the numbers of each frame up to its last nonblank cell; blank cells are NaN."""
    blocks: list[_Rows] = []
    for block in reader.rest():
        for part in block.parts(ROWS_AT_ONCE):
            rows: list[NDArray[np.float64]] = []
            for number, line in enumerate(part.lines, start=part.first):
                filled = line.rstrip() if separator == b"\t" else line.rstrip(b", \t\r\n")
                if filled and (blocks or rows or not re.match(TITLE, filled)):
                    rows.append(_read_row(filled, separator, f"{path}, line {number}"))
            if rows:
                lengths = np.array([len(row) for row in rows])
                blocks.append(_Rows(np.concatenate(rows), lengths))
            progress(part.stop, "Reading")
    if not blocks:
        raise InvalidFileError(f"{path} has a header but no frames. Export it again.")
    return blocks


def _read_row(line: bytes, separator: bytes, location: str) -> NDArray[np.float64]:
    cells = line.split(separator) if separator in line else line.split()
    try:
        row = np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:  # Spaces, or other notations of numbers or missing values.
        words = [cell.strip(b' "') for cell in cells]
        row = np.array([read_number(word, location) if word else np.nan for word in words])
    if len(row) < 2 or not (np.abs(row[:2]) < MAX_VALUE).all():
        begin = shown(line[:80].decode("ascii", "backslashreplace").replace("\t", " "))
        raise InvalidFileError(
            f"{location} begins with {begin!r} instead of the number and time of a frame. The"
            " file is damaged; export it again, or delete that line."
        )
    return row


def _columns_from_rows(
    blocks: list[_Rows], n_labels: int, path: Path | str
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return frame numbers, times, and points of shape (n_frames, n_points, 3).

    The list is emptied meanwhile, to save memory.
    """
    n_rows = sum(len(rows.lengths) for rows in blocks)
    n_points = max(n_labels, (max(int(rows.lengths.max()) for rows in blocks) - 2) // 3)
    width = 2 + 3 * n_points
    if n_rows * width > MAX_UNCHECKED_CELLS + MAX_BLANK_RATIO * sum(
        len(rows.numbers) for rows in blocks
    ):
        raise InvalidFileError(
            f"{path} has {n_points} markers in its longest line, but hardly any in the other"
            f" {n_rows} lines. It is damaged; export it again."
        )
    if not n_points:
        raise InvalidFileError(f"{path} has no markers, only the times of its frames.")
    table = np.empty((n_rows, width))
    stop = n_rows
    while blocks:
        rows = blocks.pop()
        block = table[stop - len(rows.lengths) : stop]
        block[:] = np.nan
        rows.fill(block)
        block[~(np.abs(block) < MAX_VALUE)] = np.nan
        stop -= len(block)
    points = table[:, 2:].reshape(n_rows, n_points, 3)
    return table[:, 0].copy(), table[:, 1].copy(), points


def _unit(
    header: _TrcHeader, points: NDArray[np.float64], path: Path | str, progress: Progress
) -> float:
    """Return meters per unit of the file."""
    unit = meters_from_unit_name(header.unit)
    if unit is None:
        return guess_unit_of_points(points, header.labels, progress)
    if unit < 1.0 and points.shape[1] > 1 and np.nanmax(np.abs(points)) <= FULL_TURN_RAD:
        raise InvalidFileError(
            f"{path} holds angles, or its unit is not {header.unit} as stated: no number in it"
            " is above 6.3. Export positions of markers, or give the scale."
        )
    return unit
