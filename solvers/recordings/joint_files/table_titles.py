"""Read the titles of the columns of a table, which may stand in several lines."""

import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

from ..containers import SPACE, decode_text, find_separator, is_missing, split_cells
from ..conventions import meters_from_unit_name
from ..point_bodies import is_quantity
from .json_bodies import MAX_SAMPLING_HZ, MIN_SAMPLING_HZ

MAX_TITLE_LINES = 10
"""Lines above the frames. It bounds the search; tables of Motive have seven."""
N_SAMPLED_LINES = 100
"""Lines of frames by which columns are recognized. Chosen by hand: above 1 s of most rates."""
N_PEEKED_LINES = 5000
"""Lines in which frames with points are looked for. It bounds the memory; an actor who comes
after a minute of most rates is found."""
MIN_POINTS = 8
"""Number of points of a table. It guards tables of something else, such as of one sensor."""
AXIS = re.compile(r"(?P<axis>[xyz])\d*(\s*[(\[](?P<unit>\w+)[)\]])?", re.IGNORECASE)
NUMBER = rb"([-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?|nan)"
VECTOR = re.compile(
    rb"(?i)[\[({]?\s*(?:x\s*[=:]\s*)?" + NUMBER + rb"[\s,;]+(?:y\s*[=:]\s*)?" + NUMBER
    + rb"[\s,;]+(?:z\s*[=:]\s*)?" + NUMBER + rb"\s*[\])}]?"
)  # fmt: skip
"""A cell with x, y and z, such as `(X=1.0,Y=2.0,Z=3.0)` of Unreal Engine or `[1.0 2.0 3.0]`."""
MAX_VECTOR_BYTES = 120
"""Bytes of such a cell. It bounds the search; three numbers of all digits have 75."""
BRACKETS = re.compile(rb"[\[({][^\[\](){}]*[\])}]")
MAX_UNIT_LETTERS = 12
"""Letters of the name of a unit. It guards lines of words; `millimeters` has eleven."""
INSIDE_BRACKETS = b"\x01"
"""Replaces separators inside brackets while a line is split."""
RATE = re.compile(
    rb"(?i)\b(?:capture[ _]?)?(?:fps|frames?[ _]?rate|frequency)[^\w,]{1,4}"
    rb"(\d{1,4}(?:[.,]\d+)?)"
    rb"|\b(?:fps|frames?[ _]?rate|frequency)\W{1,4}(\d{1,4}(?:\.\d+)?)"
    rb"|(?<![\d.,])(\d{1,4}(?:[.,]\d+)?) ?fps\b"
)
"""A rate in a comment above the titles. It may have a decimal comma, unless a comma separates
it from its name."""
RATE_TITLE = re.compile(r"(?i)(?:video[ _]?)?(?:fps|frame[ _]?rate)\W*(?:hz)?\W*$")
"""Title of a column with the rate of the table."""
NUMBER_OF_TABLE = re.compile(r"\d{1,4}(?:[.,]\d{0,6})?")
KIND = re.compile(r"(?i)pos(ition)?s?|loc(ation)?|translation|rot(ation)?|quat\w*|orientation")
"""What the coordinates below are, in tables that also hold rotations."""


class TableTitles(NamedTuple):
    """One title for each column of a table."""

    titles: list[str]
    n_lines: int
    """Number of lines above the frames."""
    separator: bytes
    rate: float | None = None
    """Frames per second; None if the lines above do not state it."""
    vectors: frozenset[int] = frozenset()
    """Columns of the file whose cells hold x, y and z; these have a title each."""

    def cells(self, lines: Sequence[bytes]) -> list[list[str]]:
        """Return the cells of the frames among the first lines of the file."""
        below = [line for line in lines[self.n_lines :] if line.strip()]
        return [cells_of_line(self.expand(line), self.separator) for line in below]

    def expand(self, line: bytes) -> bytes:
        """Return a line whose cells have one number each; others remain, to be refused."""
        if not self.vectors:
            return line
        cells: list[bytes] = []
        for column, cell in enumerate(_cells_with_brackets(line, self.separator)):
            if column in self.vectors:
                cells += _coordinates(cell, self.separator)
            else:
                cells.append(cell.replace(self.separator, SPACE))
        return self.separator.join(cells)


def table_titles(
    lines: Sequence[bytes], fits: Callable[[list[str]], object]
) -> TableTitles | None:
    """Return the titles of the first line that fits, or of lines of names and axes joined.

    Above it may be comments. In tables with the names above x, y and z, a name may stand in any
    of its columns. A title is then `Hips_x`, or `Hips_position_x (mm)` if kinds and units have
    lines of their own; where a line above has several people, it begins with `Anna:`. Titles
    of cells such as `(X=1.0,Y=2.0,Z=3.0)` are `Hips_x` too.

    Parameters
    ----------
    lines : sequence of bytes
        The first lines of the file.
    fits : callable
        Returns whether titles are those of the table.
    """
    joined = _joined_lines(lines)
    if joined is not None and fits(joined.titles):
        return joined
    fullest = _fullest(lines)
    for number, line in enumerate(lines[:MAX_TITLE_LINES]):
        following = [*lines[number + 1 : MAX_TITLE_LINES], *fullest]
        found = _titles_of_line(line, following)
        if fits(found.titles):
            rate = _rate(b"\n".join(lines[:number])) or _rate_of_column(found, following)
            found = found._replace(n_lines=number + 1, rate=rate)
            return _with_units(found, lines[number + 1 : number + 2])
    return None


def _with_units(found: TableTitles, below: Sequence[bytes]) -> TableTitles:
    """Return titles with the units of a line below them, if it is one."""
    units = [
        cell.strip("()[] ") for line in below for cell in cells_of_line(line, found.separator)
    ]
    words = [unit for unit in units if unit]
    is_line = any(meters_from_unit_name(word) for word in words)
    if not is_line or len(units) != len(found.titles) or not all(map(_is_unit, words)):
        return found
    titles = [
        f"{title} ({unit})" if unit else title
        for title, unit in zip(found.titles, units, strict=True)
    ]
    return found._replace(titles=titles, n_lines=found.n_lines + 1)


def _is_unit(word: str) -> bool:
    return len(word) <= MAX_UNIT_LETTERS and not any(letter.isdigit() for letter in word)


def _fullest(lines: Sequence[bytes]) -> list[bytes]:
    """Return the longest of the lines below titles: points may be missing in many others."""
    return sorted(lines[MAX_TITLE_LINES:], key=len)[-N_SAMPLED_LINES:]


def _rate(comment: bytes) -> float | None:
    """Return the rate that a comment states; None without one, or with several."""
    stated = {b"".join(groups).replace(b",", b".") for groups in RATE.findall(comment)}
    rates = {float(each) for each in stated}
    return (rates.pop() or None) if len(rates) == 1 else None


def _rate_of_column(found: TableTitles, below: Sequence[bytes]) -> float | None:
    """Return the rate in a column called so, if it is the same in all lines."""
    columns = [at for at, title in enumerate(found.titles) if RATE_TITLE.match(title)]
    rows = [cells_of_line(line, found.separator) for line in below] if columns else []
    stated = {row[columns[0]] for row in rows if len(row) == len(found.titles)}
    is_number = len(stated) == 1 and all(map(NUMBER_OF_TABLE.fullmatch, stated))
    rate = float(stated.pop().replace(",", ".")) if is_number else 0.0
    return rate if MIN_SAMPLING_HZ < rate <= MAX_SAMPLING_HZ else None


def _joined_lines(lines: Sequence[bytes]) -> TableTitles | None:
    for number, line in enumerate(lines[1:MAX_TITLE_LINES], start=1):
        separator = find_separator(line)
        axes = [AXIS.fullmatch(cell) for cell in cells_of_line(line, separator)]
        if sum(match is not None for match in axes) >= 3 * MIN_POINTS:
            rows = [cells_of_line(each, separator) for each in lines[: number + 2]]
            joined = _joined(rows[:number], axes, rows[number])
            if joined is None:
                break
            units = [_padded(row, len(axes)) for row in rows[number + 1 :]]
            if units and _are_units(units[0], axes):
                joined = [
                    f"{title} ({unit})" if match and unit else title
                    for title, match, unit in zip(joined, axes, units[0], strict=True)
                ]
                number += 1
            return TableTitles(joined, number + 1, separator)
    return None


def _titles_of_line(line: bytes, following: Sequence[bytes]) -> TableTitles:
    """Return the titles of one line; the first one may be blank, as that of an index.

    Cells of vectors may be blank in some of the lines that follow.
    """
    separator = find_separator(line)
    titles = cells_of_line(line.lstrip(b"#% "), separator)
    vectors: set[int] = set()
    for cells in (_cells_with_brackets(each, separator) for each in following):
        if len(cells) == len(titles):
            vectors |= {column for column, cell in enumerate(cells) if _vector(cell)}
    if len(vectors) < MIN_POINTS:
        return TableTitles(titles, 1, separator)
    expanded = [
        title if axis == "" else f"{title}_{axis}"
        for column, title in enumerate(titles)
        for axis in ("xyz" if column in vectors else ("",))
    ]
    return TableTitles(expanded, 1, separator, vectors=frozenset(vectors))


def _vector(cell: bytes) -> re.Match[bytes] | None:
    return VECTOR.fullmatch(cell) if len(cell) <= MAX_VECTOR_BYTES else None


def _coordinates(cell: bytes, separator: bytes) -> Sequence[bytes]:
    """Return x, y and z of a cell, blank if it is; one that has none of them is the first."""
    if match := _vector(cell):
        return match.groups()
    word = b"" if is_missing(cell) else b"'" + cell.replace(separator, SPACE) + b"'"
    return [word.replace(SPACE, b"__"), b"", b""]


def _cells_with_brackets(line: bytes, separator: bytes) -> list[bytes]:
    """Return the cells of a line in which brackets may enclose separators."""
    hidden = BRACKETS.sub(lambda match: match[0].replace(separator, INSIDE_BRACKETS), line)
    return [cell.replace(INSIDE_BRACKETS, separator) for cell in split_cells(hidden, separator)]


def cells_of_line(line: bytes, separator: bytes) -> list[str]:
    """Return the cells of a line, decoded."""
    return [decode_text(cell) for cell in split_cells(line, separator)]


def _padded(row: list[str], width: int) -> list[str]:
    return (row + [""] * width)[:width]


def _joined(
    rows: list[list[str]], axes: list[re.Match[str] | None], titles: list[str]
) -> list[str] | None:
    """Return a title for each column; None if no line has enough names."""
    names: list[str] = []
    people: list[str] = []
    kinds = [""] * len(axes)
    for row in rows:
        spread = _spread(_padded(row, len(axes)), axes)
        found = {name for name, match in zip(spread, axes, strict=True) if match}
        if all(KIND.fullmatch(name) or is_quantity(name) for name in found):
            kinds = spread
        elif not names and sum(_is_name(name) for name in found) >= MIN_POINTS:
            names = spread
        elif not names and len(found) > 1:
            people = spread
    if not names:
        return None
    joined = []
    for column, match in enumerate(axes):
        if match is None:
            above = [_padded(row, len(axes))[column] for row in rows]
            joined.append(titles[column] or next((each for each in above if each), ""))
            continue
        parts = [names[column], kinds[column], match["axis"]]
        title = "_".join(part for part in parts if part)
        person = f"{people[column]}:" if people and people[column] else ""
        joined.append(person + title + (f" ({match['unit']})" if match["unit"] else ""))
    return joined


def _is_name(name: str) -> bool:
    return any(letter.isalpha() for letter in name)


def _spread(row: list[str], axes: list[re.Match[str] | None]) -> list[str]:
    """Return the name of each column that is an axis, also where it stands over one of three.

    Columns of one point are next to each other, with each axis once; the columns of a second
    quantity, such as its rotation, have the name of the first.
    """
    spread = [""] * len(row)
    group: list[int] = []
    name = before = ""

    def close() -> None:
        for column in group:
            spread[column] = name or before

    group_axes: set[str] = set()
    for column, match in enumerate(axes):
        if match is None:
            continue
        cell, axis = row[column], match["axis"].lower()
        if axis in group_axes or (name and cell and cell != name):
            close()
            group, group_axes, before, name = [], set(), name or before, ""
        group.append(column)
        group_axes.add(axis)
        name = name or cell
    close()
    return spread


def _are_units(row: list[str], axes: list[re.Match[str] | None]) -> bool:
    units = [cell for cell, match in zip(row, axes, strict=True) if match and cell]
    return bool(units) and all(meters_from_unit_name(unit) is not None for unit in units)
