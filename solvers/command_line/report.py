"""What came of a whole batch: `report.html` for eyes, `report.json` for programs."""

import json
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from pathlib import Path, PurePosixPath
from string import Template
from typing import Any, NamedTuple

from ..faults import Failure, attempt
from ..files import write_atomically
from ..pictures import StickFigureSettings, draw_stick_figures
from ..recordings import is_depth, read_motion_or_tracks
from .verb import Task

PAGE, FIGURES, PICTURES = "report.html", "report.json", Path("report")
PICTURE = ".png"
"""What follows the name of an output in the name of its picture."""
TEMPLATE = Path(__file__).with_name("report.html")
UNITS = {
    "_m_per_s3": " (m/s³)", "_cm_per_s": " (cm/s)", "_hz": " (Hz)", "_deg": " (°)",
    "_cm": " (cm)", "_mm": " (mm)", "_m": " (m)", "_s": " (s)",
}  # fmt: skip
UNCHANGED = ("n_frames", "frame_rate_hz")
MANY = 1000.0
"""From this size on, numbers are shown without decimals."""
SECTION = Template("""<section class="$kind" id="$anchor"><h2>$title</h2>
<p class="path">$source → $target</p>
$message<div class="figures"><table>$cells</table></div>
$picture</section>
""")


class Entry(NamedTuple):
    """What came of one file."""

    task: Task
    figures: Mapping[str, Any] | None
    """None where it failed, or was not come to."""
    failure: str = ""


def picture_file(task: Task) -> Path:
    """Return where the picture of a task that is written to a folder belongs."""
    folder: Path = task.arguments.output_folder
    return folder / _picture(task)


def has_picture(task: Task) -> bool:
    """Whether it is there."""
    return picture_file(task).exists()


def forget_picture(task: Task) -> None:
    """Take away the picture of what was there before."""
    picture_file(task).unlink(missing_ok=True)


def draw_task(task: Task) -> str:
    """Draw what was read and what was written over each other, as stick figures.

    What cannot be drawn has no picture: a report must not fail where the work was done.

    Returns
    -------
    str
        The sentence of a bug in Mocap Assist; empty if there was none.
    """
    drawn = attempt(task.subject, _draw, task)
    if not isinstance(drawn, Failure):
        return ""
    forget_picture(task)
    return drawn.sentence if drawn.is_fault else ""


def _draw(task: Task) -> None:
    assert task.target is not None
    picture = picture_file(task)
    made = read_motion_or_tracks(task.target)
    both = {"result": made}
    if not is_depth(task.source):
        given = read_motion_or_tracks(task.source, scale=task.arguments.scale)
        both = {"given": given, **both} if given.n_frames == made.n_frames else both
    picture.parent.mkdir(parents=True, exist_ok=True)
    draw_stick_figures(both, StickFigureSettings(n_figures=9, height=150)).save(picture)


def write_report(folder: Path, verb: str, entries: Sequence[Entry]) -> tuple[str, ...]:
    """Write both reports, each whole or not at all.

    An entry whose figures cannot be shown is a failure in the report.

    Parameters
    ----------
    folder : Path
        Of the outputs. Pictures that are there are shown.
    verb : str
    entries : sequence of Entry
        Of all files that were named, in that order.

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
    waiting = [entry for entry in entries if entry.figures is None and not entry.failure]
    done = len(entries) - len(failed) - len(waiting)
    counts = {"done": done, "failed": len(failed), "not come to": len(waiting)}
    listed = [_listed(entry) for entry in entries]
    with write_atomically(folder / FIGURES) as part:
        said = {"verb": verb, **counts, "files": listed}
        part.write_text(json.dumps(said, indent=1, allow_nan=False), encoding="utf-8")
    ordered = sorted(entries, key=lambda entry: -_badness(entry))
    page = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        verb=escape(verb),
        summary=", ".join(f"{count} {kind}" for kind, count in counts.items() if count),
        overview=_overview(ordered),
        sections="".join(_section(entry, at) for at, entry in enumerate(ordered)),
    )
    with write_atomically(folder / PAGE) as part:
        part.write_text(page, encoding="utf-8", errors="backslashreplace")
    return faults


def _checked(entry: Entry) -> None:
    """Do all that the reports do with an entry, so that one that fails is known before."""
    json.dumps(_listed(entry), allow_nan=False)
    _badness(entry)
    _overview([entry])
    _section(entry, 0)


def _picture(task: Task) -> Path:
    """Return where the picture of a task is, within the folder of the outputs."""
    assert task.target is not None
    place = task.target.relative_to(task.arguments.output_folder)
    return PICTURES / place.with_name(place.name + PICTURE)


def _listed(entry: Entry) -> dict[str, Any]:
    task = entry.task
    listed: dict[str, Any] = {"input": str(task.source), "output": str(task.target)}
    if entry.failure:
        listed["error"] = entry.failure
    elif entry.figures is not None and has_picture(task):
        listed["picture"] = _picture(task).as_posix()
    return {**listed, **(entry.figures or {})}


def _badness(entry: Entry) -> float:
    """Order sections: failures first, then what is still most jittery."""
    if entry.figures is None:
        return float("inf")
    after = entry.figures.get("after", entry.figures)
    jitter = after.get("mean_jitter_m_per_s3") if isinstance(after, Mapping) else None
    return float(jitter or 0.0)


def _overview(entries: Sequence[Entry]) -> str:
    """Return a table with a line for each file: its numbers, where they can be compared."""
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
    """Return a file's numbers, before and after where both are known, as they are shown."""
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
        place = escape(_address(_picture(task)))
        image = f'<img loading="lazy" src="{place}" alt="Given and result, from the side">'
    message = entry.failure or ("" if entry.figures is not None else "Not come to yet.")
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


def _address(place: Path) -> str:
    """Return a place beside the page as a browser understands it."""
    return PurePosixPath("/", *place.parts).as_uri().removeprefix("file:///")


def _rows(figures: Mapping[str, Any]) -> Iterator[str]:
    """Yield a row for each single figure, before and after side by side."""
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
        return f"{value:,.0f}" if abs(value) >= MANY else f"{value:.3g}"
    return escape(str(value))
