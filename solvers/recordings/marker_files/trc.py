"""Read TRC files: marker tracks of Motion Analysis systems and of OpenSim."""

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...motion import Tracks
from ...progress import Progress, unwatched, within
from ..containers import ROWS_AT_ONCE, LineReader, read_number, shown
from ..conventions import (
    MIN_BODY_JOINTS,
    ConstantRate,
    check_scale,
    constant_rate_from_times,
    guess_unit_of_points,
    meters_from_unit_name,
    point_names,
    points_z_up,
)

FIRST_LINES = 30
"""Within these the header ends."""
TITLE_OF_TIMES = r'(?i)[\s"]*frame\s*#?"?\s*"?(time\w*)?[ "]*\t?'
TITLE = rb'[\s"]*[A-Za-z]'
"""How the line begins that says X1, Y1, Z1 and so on."""
FULL_TURN = 2.0 * np.pi
MAX_VALUE = 1e12
"""What is larger is no measurement; some programs write so what they did not see."""
MIN_RATE_HZ, MAX_RATE_HZ = 1e-3, 1e6
MAX_BLANK_RATIO = 10
FREE_CELLS = 1_000_000
MILLISECOND = 0.001


class _Header(NamedTuple):
    """What stands above the numbers."""

    rate: float | None
    unit: str
    up: str
    labels: list[str]
    n_lines: int


def read_trc(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Tracks:
    """Read the markers of a TRC file, in metres, Z up; what was not seen is NaN.

    A marker is not seen where a coordinate is blank or no number, or where it lies exactly at
    the origin, by which some programs mean the same. How many markers and frames there are is
    counted, whatever the header says; columns beyond the last name are markers without one.

    The frame rate is the DataRate of the header if the times of the frames bear it out, else
    that of the times, in seconds or, where only they fit it, milliseconds; frames that were
    left out are gaps, and uneven times are resampled (`ConstantRate`). Up is what the first
    line says in a cell such as `Y up`, as our own files do; else it is guessed to be Y or Z
    from a body's points (`points_z_up`), and is Y, as the format has it, where they are too few
    for a body. Which way the actor faces is not changed.

    Parameters
    ----------
    path : Path or str
    scale : float, metres per unit of the file, or None
        None takes the file's word (Units) or, where it has none, the one of metres, centimetres
        and millimetres that gives a person's size.
    progress : Progress

    Returns
    -------
    Tracks
        Names without the actor's (`Anna:LFHD`) if there is only one, and different from each
        other (`LFHD_2`); unnamed markers are called `point_<number>`.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, no TRC file, has no markers, or holds angles.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    reader = LineReader(path)
    header = _read_header(reader.peek(FIRST_LINES), path)
    reader.take(header.n_lines)
    rows = _read_rows(reader, path, within(progress, 0.0, 0.8))
    frames, times, points = _columns_from_rows(rows, len(header.labels), path)
    points[(points == 0.0).all(axis=-1) | ~np.isfinite(points).all(axis=-1)] = np.nan
    if np.isnan(points).all():
        raise InvalidFileError(f"{path} has no markers that are seen in any frame.")
    points *= _unit(header, points, path) if scale is None else scale
    points, rate = _at_constant_rate(points, frames, times, header.rate, path)
    labels = header.labels + [""] * (points.shape[1] - len(header.labels))
    up = header.up or ("+Y" if len(labels) < MIN_BODY_JOINTS else "")
    tracks = Tracks(point_names(labels), points_z_up(points, up), rate)
    progress(1.0, "Reading")
    return tracks


def _read_header(lines: list[bytes], path: Path | str) -> _Header:
    """Read all down to the names, which stand in the line that begins with `Frame#`."""
    texts = [_decode(line) for line in lines]
    named = next(
        (place for place, text in enumerate(texts) if re.match(r'(?i)[\s"]*frame', text)), None
    )
    if named is None:
        raise InvalidFileError(
            f"{path} has no line that begins with Frame# and lists the markers. It is no TRC"
            " file, or is damaged; export it again."
        )
    keys = next(
        (place for place, text in enumerate(texts[:named]) if "datarate" in text.lower()), None
    )
    said = {} if keys is None else _parse_header_fields(texts[keys], texts[keys + 1])
    up = re.search(r"(?i)\t\s*([+-]?[XYZ]) up\s*(\t|$)", texts[0])
    rate = None
    if word := said.get("datarate"):
        rate = read_number(word.encode(), f"{path}, line {(keys or 0) + 2}, DataRate")
    return _Header(
        rate=rate if rate is not None and MIN_RATE_HZ < rate < MAX_RATE_HZ else None,
        unit=said.get("units", "").partition(" ")[0],
        up=up[1].upper() if up else "",
        labels=_labels(texts[named]),
        n_lines=named + 1,
    )


def _decode(line: bytes) -> str:
    try:
        return line.decode()
    except UnicodeDecodeError:
        return line.decode("latin-1")


def _cells(text: str) -> list[str]:
    """Return what stands between tabs, or between spaces where there are no tabs."""
    cells = text.rstrip().split("\t") if "\t" in text.rstrip() else text.split()
    return [cell.strip(' "') for cell in cells]


def _parse_header_fields(keys: str, values: str) -> dict[str, str]:
    """Return the second and third line as one; some programs put two tabs between values."""
    named, given = _cells(keys.lower()), _cells(values)
    filled = [[cell for cell in cells if cell] for cells in (named, given)]
    if len(filled[0]) == len(filled[1]):
        named, given = filled
    return dict(zip(named, given, strict=False))


def _labels(text: str) -> list[str]:
    """Return the names: each above the first of its three columns, or without space between.

    Some programs put a space instead of a tab between `Time` and the first name.
    """
    title = re.match(TITLE_OF_TIMES, text)
    rest = text[title.end() :] if title else ""
    names = _cells(f"-\t{rest}")[1:] if "\t" in text.rstrip() else rest.split()
    filled = [place for place, name in enumerate(names) if name]
    if all(place % 3 == 0 for place in filled):
        return names[::3]
    return [names[place] for place in filled]


class _Rows(NamedTuple):
    """Rows of different lengths, one after the other."""

    numbers: NDArray[np.float64]
    lengths: NDArray[np.intp]

    def fill(self, table: NDArray[np.float64]) -> None:
        """Write each row from the left of a table, shape (n_rows, width)."""
        length = int(self.lengths[0])
        if length <= table.shape[1] and (self.lengths == length).all():
            table[:, :length] = self.numbers.reshape(-1, length)
            return
        stops = np.cumsum(self.lengths)
        for row, stop, length in zip(table, stops, self.lengths, strict=True):
            row[:length] = self.numbers[stop - length : stop][: len(row)]


def _read_rows(reader: LineReader, path: Path | str, progress: Progress) -> list[_Rows]:
    """Return the numbers of each frame, NaN where blank, up to the last that is not."""
    found: list[_Rows] = []
    for block in reader.rest():
        for part in block.parts(ROWS_AT_ONCE):
            rows: list[NDArray[np.float64]] = []
            for number, line in enumerate(part.lines, start=part.first):
                filled = line.rstrip()
                if filled and (found or rows or not re.match(TITLE, filled)):
                    rows.append(_read_row(filled, f"{path}, line {number}"))
            if rows:
                lengths = np.array([len(row) for row in rows])
                found.append(_Rows(np.concatenate(rows), lengths))
            progress(part.stop, "Reading")
    if not found:
        raise InvalidFileError(f"{path} has a header but no frames. Export it again.")
    return found


def _read_row(line: bytes, place: str) -> NDArray[np.float64]:
    cells = line.split(b"\t") if b"\t" in line else line.split()
    try:
        row = np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:  # Blanks, or other ways to write a number or that there is none.
        words = [cell.strip(b' "') for cell in cells]
        row = np.array([read_number(word, place) if word else np.nan for word in words])
    if len(row) < 2 or not (np.abs(row[:2]) < MAX_VALUE).all():
        begin = shown(line[:80].decode("ascii", "backslashreplace").replace("\t", " "))
        raise InvalidFileError(
            f"{place} begins with {begin!r} where the number and the time of a frame belong."
            " The file is damaged; export it again, or delete that line."
        )
    return row


def _columns_from_rows(
    found: list[_Rows], n_labels: int, path: Path | str
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return frame numbers, times, and points of shape (n_frames, n_points, 3).

    The list is emptied on the way, so that nothing is in memory twice.
    """
    n_rows = sum(len(rows.lengths) for rows in found)
    n_points = max(n_labels, (max(int(rows.lengths.max()) for rows in found) - 2) // 3)
    width = 2 + 3 * n_points
    if n_rows * width > FREE_CELLS + MAX_BLANK_RATIO * sum(len(rows.numbers) for rows in found):
        raise InvalidFileError(
            f"{path} has {n_points} markers by its longest line, but hardly any in the other"
            f" {n_rows} lines. It is damaged; export it again."
        )
    if not n_points:
        raise InvalidFileError(f"{path} has no markers, only the times of its frames.")
    table = np.empty((n_rows, width))
    stop = n_rows
    while found:
        rows = found.pop()
        block = table[stop - len(rows.lengths) : stop]
        block[:] = np.nan
        rows.fill(block)
        block[~(np.abs(block) < MAX_VALUE)] = np.nan
        stop -= len(block)
    points = table[:, 2:].reshape(n_rows, n_points, 3)
    return table[:, 0].copy(), table[:, 1].copy(), points


def _unit(header: _Header, points: NDArray[np.float64], path: Path | str) -> float:
    """Return metres per unit of the file."""
    said = meters_from_unit_name(header.unit)
    if said is None:
        return guess_unit_of_points(points)
    if said < 1.0 and points.shape[1] > 1 and np.nanmax(np.abs(points)) <= FULL_TURN:
        raise InvalidFileError(
            f"{path} holds angles, or its unit is not {header.unit} as it says: no number in it"
            " is above 6.3. Export positions of markers, or give the scale."
        )
    return said


def _at_constant_rate(
    points: NDArray[np.float64],
    frames: NDArray[np.float64],
    times: NDArray[np.float64],
    said: float | None,
    path: Path | str,
) -> tuple[NDArray[np.float64], float]:
    """Go by the times; where they do not increase, by the frame numbers; else by neither."""
    rate = said
    if said is not None and not _increases(times) and _increases(frames):
        times = frames / said
    if _increases(times):
        if said is not None and constant_rate_from_times(MILLISECOND * times, said) == said:
            times = MILLISECOND * times
        rate = constant_rate_from_times(times, said)
        if rate is None:
            clock = ConstantRate(path, times, said)
            points, rate = clock.positions(points), clock.frame_rate
    if rate is None or not MIN_RATE_HZ < rate < MAX_RATE_HZ:
        raise InvalidFileError(f"{path} does not say its frame rate.")
    return points, rate


def _increases(values: NDArray[np.float64]) -> bool:
    return len(values) > 1 and bool((np.diff(values) > 0.0).all())
