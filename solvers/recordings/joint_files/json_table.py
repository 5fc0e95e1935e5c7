"""Read tables in JSON: those of pandas, and arrays next to a list of the names of joints."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any

from ...errors import InvalidFileError
from ...motion import JointRecording, Tracks
from ...progress import Progress, unwatched
from ..containers import json_content, printable, read_bytes
from ..conventions import Bodies, check_scale, meters_from_unit_name
from ..point_bodies import coordinate_of_title, is_frame_title, time_name
from .json_bodies import is_frames_json, open_frames_json, stated_rates
from .long_columns import long_columns
from .long_table import open_long_table
from .point_table import has_points, open_point_table
from .table_rows import INDEX, TitledRows, named_arrays, with_index
from .untitled_tables import numbered_titles

HEAD_BYTES = 4096
"""Bytes by which formats are detected, by definition those of `formats`."""
MAX_CELLS = 1 << 24
"""Cells of a table, above which half must be in the file. It bounds the memory of files whose
rows have other titles each."""
STRING = re.compile(r'"((?:[^"\\]|\\.){0,200})"')
KEY = re.compile(STRING.pattern + r"\s*:")
RECORD = re.compile(
    r"\s*(?:\[\s*|\{[^{}]*\"\w+\"\s*:\s*\[\s*|\{\s*\"schema\".*?\"data\"\s*:\s*\[\s*"
    r"|\{\s*\"\d[^\"]*\"\s*:\s*)?\{([^{}\[\]]+)",
    re.DOTALL,
)
"""Titles and values of the first row, where each row has them."""
SPLIT = re.compile(r'\s*\{\s*"columns"\s*:\s*\[((?:[^{}\]]|\]\s*,\s*\[)*)')
"""Titles in a list of their own."""
COLUMN = re.compile(
    STRING.pattern
    + r"\s*:\s*(?:\{\s*\"\d[^\"]*\"\s*:\s*(?![{\[])"
    + r"|\[(?:\s*(?:-?\d[^,\[\]{}]*|null)\s*,){4})"
)
"""Title of a column whose values are listed, or keyed by the number of their row."""
STAMPS = re.compile(r"\s*\{\s*" + STRING.pattern + r"\s*:\s*\{\s*\"\d[^\"]*\"\s*:\s*[-\d\"n]")
"""Title of the first column, where its values are keyed so; those of others are far away."""
NAMES = re.compile(
    r"(?i)\s*\{(?:[^\[\]{}]|\{[^\[\]{}]*\}|\[[^\[\]{}]*\])*"
    r"(?:\{(?:[^\[\]{}]|\[[^\[\]{}]*\])*)?"
    r"\"(?:joint|bone|key_?point|landmark|marker|point|body|part|segment)?s?[_ ]?"
    r"(?:names?|labels|order|joints|bones|columns|parts|markers)\"\s*:\s*\[(?:\s*\"[^\"]*\"\s*,){7}"
)
"""Member of the outermost object, or of one in it, with the names of joints."""
FRAMES = re.compile(r"\[\s*\[\s*\[\s*-?\d")
"""Positions of joints in several frames."""
ROWS = re.compile(r"\s*\[\s*\[[^\[\]{}\"]*\]")
"""The first row of a list of rows of numbers, as pandas writes with `orient="values"`."""
ROW = re.compile(r"\[([^\[\]{}\"]*)\]")
UNIT_KEY = re.compile(r"(?i)(?:(?:length|position|coordinate|joint)s?_?)?units?")
"""Member with the unit of length."""
PART_OF_TITLE = re.compile(r"'([^']*)'")


def is_json_table(head: bytes) -> bool:
    """Return whether a file is a table in JSON that names points, from its first bytes."""
    if head.lstrip()[:1] not in {b"{", b"["}:
        return False
    text = head.decode("utf-8", "replace")
    for pattern in (SPLIT, RECORD):
        match = pattern.match(text)
        found = (STRING if pattern is SPLIT else KEY).findall(match[1]) if match else []
        if _fits([_title(each) for each in found]) or _fits(_joined(found)):
            return True
    if (stamps := STAMPS.match(text)) and _is_stamp(_title(stamps[1])):
        return True
    titles = [_title(each) for each in COLUMN.findall(text)]
    is_first = bool(titles) and text.lstrip().startswith(("{", '{"'))
    if is_first and any(map(_is_column, titles)):
        return True
    if ROWS.match(text) and _is_stamped([*map(str.encode, ROW.findall(text))]):
        return True
    is_array = FRAMES.search(text) is not None or not is_frames_json(head)
    return NAMES.match(text) is not None and is_array


def open_json_table(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording | Tracks]:
    """Open a table in JSON as `open_point_table` and `open_long_table` open one of text.

    Rows may be objects with a value for each title, in a list or keyed by number; columns may
    be lists, or keyed by the number of their row; titles may be in a list of their own next to
    the rows. Rows of numbers alone are read where each is the number or time of a frame and a
    body in a known order. Names of joints may be next to an array of their positions, which has
    a row for each frame or is flat. A unit next to them, such as `"unit": "mm"`, counts.

    Raises
    ------
    InvalidFileError
        The file is damaged, or has no columns of points.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    content = json_content(path).value
    if isinstance(content, list) and all(isinstance(each, list) for each in content):
        return open_point_table(
            path, scale=scale, progress=progress, lines=[_line(row).encode() for row in content]
        )
    table = next((each for each in _tables(content) if _fits(each.titles)), None)
    if table is None and FRAMES.search(
        read_bytes(path)[:HEAD_BYTES].decode("utf-8", "replace")
    ):
        return open_frames_json(path, scale=scale, progress=progress)
    if table is None:
        raise InvalidFileError(
            f"{path} has no table of points. Export columns such as LeftHand_x, or the names of"
            " joints next to an array of the shape (frames, joints, 3)."
        )
    if table.remark is not None:
        progress(0.1, table.remark)
    scale = next(_stated_units(content), None) if scale is None else scale
    rate = min(stated_rates(content), default=None)
    comment = [] if rate is None else [f"# fps: {rate.rate:.10g}"]
    lines = [*comment, *map(_line, (table.titles, *table.rows))]
    open_table = open_long_table if long_columns(table.titles) else open_point_table
    return open_table(
        path, scale=scale, progress=progress, lines=[line.encode() for line in lines]
    )


def _is_stamped(rows: list[bytes]) -> bool:
    """Return whether rows of numbers are the stamp of a frame and the joints of a body."""
    found = numbered_titles(rows)
    return found is not None and _is_stamp(found.titles[0])


def _stated_units(value: Any) -> Iterator[float]:
    """Yield the meters per unit in members of the outermost object, and of those in it."""
    if not isinstance(value, Mapping):
        return
    for inner in (value, *(each for each in value.values() if isinstance(each, Mapping))):
        for key, word in inner.items():
            unit = meters_from_unit_name(word) if isinstance(word, str) else None
            if unit is not None and UNIT_KEY.fullmatch(str(key)):
                yield unit


def _fits(titles: Sequence[str]) -> bool:
    return has_points(titles) or long_columns(titles) is not None


def _is_stamp(title: str) -> bool:
    return time_name(title) is not None or is_frame_title(title)


def _is_column(title: str) -> bool:
    return coordinate_of_title(title) is not None


def _title(value: Any) -> str:
    """Return a title, which may have several levels, as a list or as Python writes a tuple."""
    parts = value if isinstance(value, list) else None
    if parts is None and str(value).startswith("('"):
        parts = PART_OF_TITLE.findall(str(value))
    return printable("_".join(map(str, filter(None, parts))) if parts else str(value))


def _joined(words: Sequence[str]) -> list[str]:
    """Return the words of titles with two levels, which a list has next to each other."""
    return [f"{name}_{axis}" for name, axis in zip(words[::2], words[1::2], strict=False)]


def _tables(value: Any) -> Iterator[TitledRows]:
    """Yield what a value may be as a table."""
    if isinstance(value, list):
        yield from _of_records(value)
    if not isinstance(value, Mapping):
        return
    lists = dict(_lists(value))
    if "columns" in lists and "data" in lists:
        titled = TitledRows([*map(_title, lists["columns"])], lists["data"])
        yield with_index(titled, lists.get("index", ()))
    for listed in lists.values():
        yield from _of_records(listed, title=_title_of_index(value))
    inner = (each for each in value.values() if isinstance(each, Mapping))
    yield from named_arrays([*_lists(value), *chain.from_iterable(map(_lists, inner))])
    nested = {key: each for key, each in value.items() if isinstance(each, Mapping)}
    yield from _of_columns({key: dict(enumerate(each)) for key, each in lists.items()})
    yield from _of_columns(nested)
    yield from _of_records([*nested.values()], [*nested])
    for each in nested.values():
        yield from _tables({key: inner for key, inner in each.items() if key not in nested})


def _title_of_index(value: Mapping[str, Any]) -> str:
    """Return the title of the index that the schema of pandas names."""
    schema = value.get("schema")
    keys = schema.get("primaryKey") if isinstance(schema, Mapping) else None
    return str(keys[0]) if isinstance(keys, list) and len(keys) == 1 else INDEX


def _of_records(
    values: list[Any], index: Sequence[str] = (), title: str = INDEX
) -> Iterator[TitledRows]:
    if not values or not all(isinstance(each, Mapping) for each in values):
        return
    titles = [*dict.fromkeys(key for each in values for key in each)]
    if _is_sparse(values, titles):
        return
    rows = [[each.get(title) for title in titles] for each in values]
    yield with_index(TitledRows([*map(_title, titles)], rows), index, title)


def _of_columns(columns: Mapping[str, Mapping[Any, Any]]) -> Iterator[TitledRows]:
    """Yield columns that store their values by the keys of the rows."""
    index = [*dict.fromkeys(key for each in columns.values() for key in each)]
    if not columns or _is_sparse(columns.values(), index):
        return
    rows = [[each.get(key) for each in columns.values()] for key in index]
    yield with_index(TitledRows([*map(_title, columns)], rows), index)


def _is_sparse(values: Collection[Mapping[Any, Any]], keys: Sequence[Any]) -> bool:
    """Return whether a large table would be mostly blank, as a damaged one is."""
    n_cells = len(values) * len(keys)
    return n_cells > MAX_CELLS and n_cells > 2 * sum(map(len, values))


def _lists(value: Mapping[str, Any]) -> Iterator[tuple[str, list[Any]]]:
    return ((key, each) for key, each in value.items() if isinstance(each, list) and each)


def _line(cells: Iterable[Any]) -> str:
    return ",".join(map(_cell, cells))


def _cell(value: Any) -> str:
    """Return the text of a cell; a position is one, too."""
    if value is None or value != value:
        return ""
    if isinstance(value, bool | Mapping):
        return ""
    if isinstance(value, list):
        return "[" + " ".join(map(_cell, value)) + "]"
    text = printable(str(value)).replace('"', "'")
    return f'"{text}"' if isinstance(value, str) else text
