"""Write the report of a batch: `report.html` for people, `report.json` for programs."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from html import escape
from pathlib import Path, PurePosixPath
from string import Template
from typing import Any, NamedTuple

from ...faults import Failure, attempt
from ...files import remove_leftovers, write_atomically
from ..arguments import Task
from ..sharing import Record, Records, claimed

PAGE, FIGURES, PICTURES = "report.html", "report.json", Path("report")
PICTURE = ".png"
"""Suffix of the picture of an output."""
FORMER_PENDING = "not come to"
"""Key of the number of pending files that programs for earlier versions read."""
TEMPLATE = Path(__file__).with_name("report.html")
UNITS = {
    "_m_per_s3": " (m/s³)", "_cm_per_s": " (cm/s)", "_hz": " (Hz)", "_deg": " (°)",
    "_cm": " (cm)", "_mm": " (mm)", "_m": " (m)", "_s": " (s)",
}  # fmt: skip
UNCHANGED = ("n_frames", "frame_rate_hz")
MIN_ROUNDED_VALUE = 1000.0
"""Size of a number, relative to its unit, from which figures are shown without decimals. It
bounds the width of a column."""
SECTION = Template("""<section class="$kind" id="$anchor"><h2>$title</h2>
<p class="path">$source → $target</p>
$message<div class="figures"><table>$cells</table></div>
$picture</section>
""")


class Entry(NamedTuple):
    """The entry of a report for one file."""

    source: str
    target: str
    picture: Path
    """Relative to the output folder; it may be missing."""
    figures: Mapping[str, Any] | None = None
    """None if it failed or was not processed."""
    failure: str = ""
    remarks: tuple[str, ...] = ()
    identifier: str = ""

    def with_record(self, record: Record) -> "Entry":
        """Return the entry of a processed file."""
        return self._replace(
            figures=None if record.error else record.figures,
            failure=record.error,
            remarks=tuple(record.remarks),
            identifier=record.identifier,
        )

    @property
    def name(self) -> str:
        """Name of the input."""
        return Path(self.source).name


def picture_file(task: Task) -> Path:
    """Return the path of the picture of a task with an output folder."""
    folder: Path = task.arguments.output_folder
    return folder / picture_of(output_of(task))


def has_picture(task: Task) -> bool:
    """Return whether the picture exists."""
    return picture_file(task).exists()


def remove_picture(task: Task) -> None:
    """Remove the picture of an earlier result."""
    picture_file(task).unlink(missing_ok=True)


def output_of(task: Task) -> str:
    """Return the output relative to the output folder, as records name it."""
    assert task.target is not None
    return task.target.relative_to(task.arguments.output_folder).as_posix()


def picture_of(output: str) -> Path:
    """Return the path of the picture of an output, relative to the output folder."""
    return PICTURES / f"{output}{PICTURE}"


def write_report(
    folder: Path, verb: str, collect: Callable[[], list[Entry]]
) -> tuple[str, ...]:
    """Write both reports, each atomically, with the records of all machines.

    Where another machine adds a record meanwhile, they are written again, unless it still
    works on a take: it writes them at its end with `--report`. An entry whose figures cannot
    be shown is a failure in the report.

    Parameters
    ----------
    folder : Path
        The output folder. Existing pictures are shown.
    verb : str
    collect : callable
        Reads the records; returns one entry per input file, in their order.

    Returns
    -------
    tuple of str
        A sentence for each entry that could not be shown.
    """
    records = Records(folder)
    with claimed(records.claim(PAGE)) as claim:
        if claim.taken_over:
            remove_leftovers([folder / FIGURES, folder / PAGE])
        entries = collect()
        while True:
            faults = _write(folder, verb, entries)
            written, entries = entries, collect()
            if _stamps(written) == _stamps(entries) or records.has_claims(but=PAGE):
                return faults


def _stamps(entries: Sequence[Entry]) -> list[tuple[str, tuple[str, ...]]]:
    return [(entry.identifier, entry.remarks) for entry in entries]


def _write(folder: Path, verb: str, entries: Sequence[Entry]) -> tuple[str, ...]:
    checked = [attempt(entry.source, _check_entry, folder, entry) for entry in entries]
    faults = tuple(each.sentence for each in checked if isinstance(each, Failure))
    entries = [
        entry._replace(figures=None, failure=found.sentence)
        if isinstance(found, Failure)
        else entry
        for entry, found in zip(entries, checked, strict=True)
    ]
    failed = [entry for entry in entries if entry.failure]
    pending = [entry for entry in entries if entry.figures is None and not entry.failure]
    done = len(entries) - len(failed) - len(pending)
    counts = {"done": done, "failed": len(failed), "pending": len(pending)}
    listed = [_report_entry(folder, entry) for entry in entries]
    with write_atomically(folder / FIGURES) as part:
        content = {"verb": verb, **counts, FORMER_PENDING: len(pending), "files": listed}
        part.write_text(json.dumps(content, indent=1, allow_nan=False), encoding="utf-8")
    ordered = sorted(entries, key=lambda entry: -_severity(entry))
    page = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        verb=escape(verb),
        summary=", ".join(f"{count} {kind}" for kind, count in counts.items() if count),
        overview=_overview(ordered),
        sections="".join(
            _section(folder, entry, number) for number, entry in enumerate(ordered)
        ),
    )
    with write_atomically(folder / PAGE) as part:
        part.write_text(page, encoding="utf-8", errors="backslashreplace")
    return faults


def _check_entry(folder: Path, entry: Entry) -> None:
    """Format an entry as both reports do, to detect failures before writing."""
    json.dumps(_report_entry(folder, entry), allow_nan=False)
    _severity(entry)
    _overview([entry])
    _section(folder, entry, 0)


def _report_entry(folder: Path, entry: Entry) -> dict[str, Any]:
    listed: dict[str, Any] = {"input": entry.source, "output": entry.target}
    if entry.failure:
        listed["error"] = entry.failure
    elif entry.figures is not None and (folder / entry.picture).exists():
        listed["picture"] = entry.picture.as_posix()
    if entry.remarks:
        listed["remarks"] = entry.remarks
    return {**listed, **(entry.figures or {})}


def _severity(entry: Entry) -> float:
    """Return the sort key of a section: failures first, then by jitter."""
    if entry.figures is None:
        return float("inf")
    after = entry.figures.get("after", entry.figures)
    jitter = after.get("mean_jitter_m_per_s3") if isinstance(after, Mapping) else None
    return float(jitter or 0.0)


def _overview(entries: Sequence[Entry]) -> str:
    """Return a table with a row of comparable numbers for each file."""
    compared = [_format_figures(entry) for entry in entries]
    columns = list(dict.fromkeys(name for numbers in compared for name in numbers))
    heads = "".join(f"<th>{_label(name)}</th>" for name in columns)
    lines = [
        f'<tr><td><a href="#file-{number}">{escape(entry.name)}</a></td>'
        + "".join(f"<td>{numbers.get(name, '')}</td>" for name in columns)
        + "</tr>"
        for number, (entry, numbers) in enumerate(zip(entries, compared, strict=True), start=1)
    ]
    return f"<table><tr><th>file</th>{heads}</tr>{''.join(lines)}</table>"


def _format_figures(entry: Entry) -> dict[str, str]:
    """Return the formatted numbers of a file, before and after where both exist."""
    figures = entry.figures or {}
    before, after = figures.get("before"), figures.get("after")
    if not isinstance(before, Mapping) or not isinstance(after, Mapping):
        return {name: _text(value) for name, value in figures.items() if _is_number(value)}
    return {
        name: f"{_text(value)} → {_text(after.get(name))}"
        for name, value in before.items()
        if _is_number(value) and name not in UNCHANGED
    }


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _section(folder: Path, entry: Entry, number: int) -> str:
    image = ""
    if entry.figures is not None and (folder / entry.picture).exists():
        path = escape(_relative_url(entry.picture))
        image = f'<img loading="lazy" src="{path}" alt="Given and result, from the side">'
    message = entry.failure or ("" if entry.figures is not None else "Not processed yet.")
    paragraphs = [escape(text) for text in (message, *entry.remarks) if text]
    return SECTION.substitute(
        kind="done" if entry.figures is not None else "failed",
        anchor=f"file-{number + 1}",
        title=escape(entry.name),
        source=escape(entry.source),
        target=escape(entry.target),
        message="".join(f"<p>{text}</p>\n" for text in paragraphs),
        cells="".join(_rows(entry.figures or {})),
        picture=image,
    )


def _relative_url(path: Path) -> str:
    """Return a path relative to the page as a URL."""
    return PurePosixPath("/", *path.parts).as_uri().removeprefix("file:///")


def _rows(figures: Mapping[str, Any]) -> Iterator[str]:
    """Yield a row for each scalar figure, before and after side by side."""
    before, after = figures.get("before"), figures.get("after")
    if isinstance(before, Mapping) and isinstance(after, Mapping):
        yield "<tr><th></th><th>before</th><th>after</th></tr>"
        for name, value in before.items():
            if _is_single(value):
                yield f"<tr><th>{_label(name)}</th>{_cell(value)}{_cell(after.get(name))}</tr>"
    for name, value in figures.items():
        if _is_single(value):
            yield f'<tr><th>{_label(name)}</th><td colspan="2">{_text(value)}</td></tr>'


def _is_single(value: Any) -> bool:
    return value is None or isinstance(value, str | int | float)


def _label(name: str) -> str:
    if name.endswith("_share"):
        return escape(name.removesuffix("_share").replace("_", " ")) + " (share)"
    unit = next((unit for unit in UNITS if name.endswith(unit)), "")
    return escape(name.removesuffix(unit).replace("_", " ")) + UNITS.get(unit, "")


def _cell(value: Any) -> str:
    return f"<td>{_text(value)}</td>"


def _text(value: Any) -> str:
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:,.0f}" if abs(value) >= MIN_ROUNDED_VALUE else f"{value:.3g}"
    return escape(str(value))
