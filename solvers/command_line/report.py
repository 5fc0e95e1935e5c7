"""Write the report of a batch: `report.html` for people, `report.json` for programs."""

import json
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from pathlib import Path, PurePosixPath
from string import Template
from typing import Any, NamedTuple

from ..faults import Failure, attempt
from ..files import write_atomically
from ..pictures import StickFigureSettings, draw_stick_figures
from ..progress import unwatched
from ..recordings import is_depth_recording, read_motion_or_tracks
from .files import read
from .verb import Task

PAGE, FIGURES, PICTURES = "report.html", "report.json", Path("report")
PICTURE = ".png"
"""Suffix of the picture of an output."""
TEMPLATE = Path(__file__).with_name("report.html")
UNITS = {
    "_m_per_s3": " (m/s³)", "_cm_per_s": " (cm/s)", "_hz": " (Hz)", "_deg": " (°)",
    "_cm": " (cm)", "_mm": " (mm)", "_m": " (m)", "_s": " (s)",
}  # fmt: skip
UNCHANGED = ("n_frames", "frame_rate_hz")
MIN_ROUNDED_VALUE = 1000.0
"""Numbers of at least this size are shown without decimals."""
SECTION = Template("""<section class="$kind" id="$anchor"><h2>$title</h2>
<p class="path">$source → $target</p>
$message<div class="figures"><table>$cells</table></div>
$picture</section>
""")


class Entry(NamedTuple):
    """The result of one file."""

    task: Task
    figures: Mapping[str, Any] | None
    """None if it failed or was not processed."""
    failure: str = ""


def picture_file(task: Task) -> Path:
    """Return the path of the picture of a task with an output folder."""
    folder: Path = task.arguments.output_folder
    return folder / _picture(task)


def has_picture(task: Task) -> bool:
    """Return whether the picture exists."""
    return picture_file(task).exists()


def remove_picture(task: Task) -> None:
    """Remove the picture of an earlier result."""
    picture_file(task).unlink(missing_ok=True)


def draw_task(task: Task) -> str:
    """Draw input and result over each other, as stick figures.

    If drawing fails there is no picture: a report must not fail after the work is done.

    Returns
    -------
    str
        The message of a bug in Mocap Assist; empty if there was none.
    """
    outcome = attempt(task.subject, _draw, task)
    if not isinstance(outcome, Failure):
        return ""
    remove_picture(task)
    return outcome.sentence if outcome.is_fault else ""


def _draw(task: Task) -> None:
    assert task.target is not None
    picture = picture_file(task)
    result = read_motion_or_tracks(task.target)
    motions = {"result": result}
    if not is_depth_recording(task.source):
        given = read(task.source, task.arguments, unwatched)
        motions = {"given": given, **motions} if given.n_frames == result.n_frames else motions
    picture.parent.mkdir(parents=True, exist_ok=True)
    draw_stick_figures(motions, StickFigureSettings(n_figures=9, height=150)).save(picture)


def write_report(folder: Path, verb: str, entries: Sequence[Entry]) -> tuple[str, ...]:
    """Write both reports, each atomically.

    An entry whose figures cannot be shown is a failure in the report.

    Parameters
    ----------
    folder : Path
        The output folder. Existing pictures are shown.
    verb : str
    entries : sequence of Entry
        One per input file, in their order.

    Returns
    -------
    tuple of str
        A sentence for each entry that could not be shown.
    """
    checked = [attempt(entry.task.subject, _checked, entry) for entry in entries]
    faults = tuple(each.sentence for each in checked if isinstance(each, Failure))
    entries = [
        Entry(entry.task, None, found.sentence) if isinstance(found, Failure) else entry
        for entry, found in zip(entries, checked, strict=True)
    ]
    failed = [entry for entry in entries if entry.failure]
    pending = [entry for entry in entries if entry.figures is None and not entry.failure]
    done = len(entries) - len(failed) - len(pending)
    counts = {"done": done, "failed": len(failed), "not come to": len(pending)}
    listed = [_listed(entry) for entry in entries]
    with write_atomically(folder / FIGURES) as part:
        content = {"verb": verb, **counts, "files": listed}
        part.write_text(json.dumps(content, indent=1, allow_nan=False), encoding="utf-8")
    ordered = sorted(entries, key=lambda entry: -_severity(entry))
    page = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        verb=escape(verb),
        summary=", ".join(f"{count} {kind}" for kind, count in counts.items() if count),
        overview=_overview(ordered),
        sections="".join(_section(entry, number) for number, entry in enumerate(ordered)),
    )
    with write_atomically(folder / PAGE) as part:
        part.write_text(page, encoding="utf-8", errors="backslashreplace")
    return faults


def _checked(entry: Entry) -> None:
    """Format an entry as both reports do, to detect failures before writing."""
    json.dumps(_listed(entry), allow_nan=False)
    _severity(entry)
    _overview([entry])
    _section(entry, 0)


def _picture(task: Task) -> Path:
    """Return the path of the picture of a task, relative to the output folder."""
    assert task.target is not None
    path = task.target.relative_to(task.arguments.output_folder)
    return PICTURES / path.with_name(path.name + PICTURE)


def _listed(entry: Entry) -> dict[str, Any]:
    task = entry.task
    listed: dict[str, Any] = {"input": str(task.source), "output": str(task.target)}
    if entry.failure:
        listed["error"] = entry.failure
    elif entry.figures is not None and has_picture(task):
        listed["picture"] = _picture(task).as_posix()
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
    compared = [_compared(entry) for entry in entries]
    columns = list(dict.fromkeys(name for numbers in compared for name in numbers))
    heads = "".join(f"<th>{_label(name)}</th>" for name in columns)
    lines = [
        f'<tr><td><a href="#file-{number}">{escape(entry.task.source.name)}</a></td>'
        + "".join(f"<td>{numbers.get(name, '')}</td>" for name in columns)
        + "</tr>"
        for number, (entry, numbers) in enumerate(zip(entries, compared, strict=True), start=1)
    ]
    return f"<table><tr><th>file</th>{heads}</tr>{''.join(lines)}</table>"


def _compared(entry: Entry) -> dict[str, str]:
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


def _section(entry: Entry, number: int) -> str:
    task = entry.task
    image = ""
    if entry.figures is not None and has_picture(task):
        path = escape(_relative_url(_picture(task)))
        image = f'<img loading="lazy" src="{path}" alt="Given and result, from the side">'
    message = entry.failure or ("" if entry.figures is not None else "Not processed yet.")
    return SECTION.substitute(
        kind="done" if entry.figures is not None else "failed",
        anchor=f"file-{number + 1}",
        title=escape(task.source.name),
        source=escape(str(task.source)),
        target=escape(str(task.target)),
        message=f"<p>{escape(message)}</p>\n" if message else "",
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
