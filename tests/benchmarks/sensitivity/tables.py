"""Tables of what was measured, for the terminal and for docs/benchmarks/sensitivity.md."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..shared.tables import wrapped
from .constants import ROOT, Constant, constants_of
from .evaluate import Outcome
from .fixed_constants import reason
from .guards import WITHOUT

DOCUMENT = ROOT / "docs" / "benchmarks" / "sensitivity.md"
MOVES_PERCENT = 0.5
"""Change of any one error of a family, percent, above which a constant moves it."""
TINY = 1e-9
SHOWN_PERCENT = 0.1
"""Change of the mean, percent, from which a constant has a row of its own."""
MAX_PERCENT = 100.0
"""An error that rises by more counts as this in the mean."""
NOT_MEASURED = "Not measured yet: "
MARK = "<!-- below: make sensitivity ARGUMENTS=--docs -->"


@dataclass(frozen=True)
class Row:
    """One constant and what its family measured with half, with twice and without it."""

    constant: Constant
    baseline: Outcome
    half: Outcome
    twice: Outcome
    without: Outcome | None = None
    """With the value without effect, for a constant of `WITHOUT`."""

    @property
    def changes(self) -> tuple[float, float]:
        """Mean change of all errors, percent; NaN where it failed."""
        return self._mean(self.half), self._mean(self.twice)

    @property
    def most_moved(self) -> tuple[str, float]:
        """Name and change, percent, of the error that changed most."""
        found = [
            (name, change)
            for outcome in (self.half, self.twice)
            for name, change in self._each(outcome).items()
        ]
        return max(found, key=lambda pair: abs(pair[1]), default=("", 0.0))

    @property
    def moves(self) -> bool:
        """Whether any error changes by more than MOVES_PERCENT at half or twice of it."""
        return abs(self.most_moved[1]) > MOVES_PERCENT

    @property
    def most_moved_without(self) -> tuple[str, float]:
        """Name and change, percent, of the error that changed most without it."""
        found = self._each(self.without).items() if self.without else ()
        return max(found, key=lambda pair: abs(pair[1]), default=("", 0.0))

    @property
    def change_without(self) -> float:
        """Mean change of all errors without it, percent; NaN if that was not measured."""
        return self._mean(self.without) if self.without else math.nan

    @property
    def is_needed(self) -> bool:
        """Whether the errors hardly change with its value, but do without it."""
        return not self.moves and abs(self.most_moved_without[1]) > MOVES_PERCENT

    @property
    def failures(self) -> dict[str, str]:
        """What went wrong, by factor."""
        found = {"x0.5": self.half.failure, "x2": self.twice.failure}
        return {
            factor: failure
            for factor, failure in found.items()
            if failure and failure != "no smaller whole number"
        }

    def _each(self, outcome: Outcome) -> dict[str, float]:
        return {
            name: 100.0 * ((figure + TINY) / (self.baseline.figures[name] + TINY) - 1.0)
            for name, figure in outcome.figures.items()
        }

    def _mean(self, outcome: Outcome) -> float:
        changes = [min(change, MAX_PERCENT) for change in self._each(outcome).values()]
        return sum(changes) / len(changes) if changes else math.nan


def family_text(family: str, rows: Sequence[Row]) -> str:
    """Return the section of one family in Markdown."""
    if not rows:
        return f"## {_title(family)}\n\nNot measured yet.\n"
    moving = sorted((row for row in rows if row.moves), key=_size, reverse=True)
    shown = [row for row in moving if _size(row) >= SHOWN_PERCENT]
    hardly = [row for row in moving if _size(row) < SHOWN_PERCENT]
    needed = [row for row in rows if row.is_needed]
    still = [row for row in rows if not (row.moves or row.failures or row.is_needed)]
    modules = sorted({_module(row) for row in [*hardly, *still]})
    errors = len(rows[0].baseline.figures)
    n_varied = sum(not reason(each.key) for each in constants_of(family))
    unmeasured = f", {len(rows)} of them measured" if len(rows) < n_varied else ""
    lines = [
        f"## {_title(family)}",
        "",
        f"{n_varied} constants{unmeasured}, {errors} errors; {len(moving)} constants move one.",
        "",
        "| constant | value | unit | x0.5 | x2 | most moved |",
        "|---|---|---|---|---|---|",
        *(_line(row) for row in shown),
        "",
        f"{len(hardly)} constants move one error, but the mean by less than"
        f" {SHOWN_PERCENT:g} %; {len(needed)} move none by half or twice, but without them;"
        f" {len(still)} move none.",
    ]
    if needed:
        lines += [
            "",
            "| constant | value | unit | without | mean | most moved |",
            "|---|---|---|---|---|---|",
            *(_line_without(row) for row in needed),
        ]
    if modules:
        lines += [
            "",
            f"| module | move the mean by less than {SHOWN_PERCENT:g} % | move no error |",
            "|---|---|---|",
            *(
                f"| {each} | {_named(hardly, each)} | {_named(still, each)} |"
                for each in modules
            ),
        ]
    failed = [row for row in rows if row.failures]
    if failed:
        lines += ["", "Failed:", "", *(wrapped(f"- {_failure(row)}") for row in failed)]
    return "\n".join(lines) + "\n"


def write_docs(families: Mapping[str, Sequence[Row]]) -> None:
    """Write the sections of the families that were measured here; the others stay as they are.

    The introduction is written by hand.
    """
    introduction, _, tables = DOCUMENT.read_text(encoding="utf-8").partition(MARK)
    old = {f"## {part.partition(chr(10))[0]}": part for part in tables.split("\n## ")[1:]}
    sections, missing = [], []
    for family, rows in families.items():
        title = f"## {_title(family)}"
        if rows:
            sections.append(family_text(family, rows))
        elif title in old:
            sections.append(f"## {old[title].partition(NOT_MEASURED)[0].strip()}\n")
        elif not all(reason(each.key) for each in constants_of(family)):
            missing.append(_title(family))
    if missing:
        sections.append(f"{NOT_MEASURED}{', '.join(missing)}.\n")
    DOCUMENT.write_text(introduction + "\n".join([MARK, "", *sections]), encoding="utf-8")


def percent(change: float) -> str:
    """Write a change with its sign; nothing where the constant could not be scaled."""
    if math.isnan(change):
        return "-"
    return f"{change:+.1f} %" if abs(change) >= 0.05 else "0"


def _line(row: Row) -> str:
    name, change = row.most_moved
    half, twice = (percent(each) for each in row.changes)
    return (
        f"| `{_short(row.constant)}` | {_number(row.constant.value)} | {row.constant.unit} "
        f"| {half} | {twice} | {name} {percent(change)} |"
    )


def _line_without(row: Row) -> str:
    name, change = row.most_moved_without
    constant, without = row.constant, WITHOUT[row.constant.key]
    return (
        f"| `{_short(constant)}` | {_number(constant.value)} | {constant.unit} "
        f"| {_number(without)} | {percent(row.change_without)} | {name} {percent(change)} |"
    )


def _failure(row: Row) -> str:
    what = "; ".join(f"{factor}: {failure}" for factor, failure in row.failures.items())
    return f"`{_short(row.constant)}` ({what.replace(f'{ROOT}/', '')})."


def _module(row: Row) -> str:
    return _short(row.constant).rpartition(".")[0]


def _named(rows: Sequence[Row], module: str) -> str:
    return ", ".join(f"`{row.constant.name}`" for row in rows if _module(row) == module)


def _size(row: Row) -> float:
    return max((abs(each) for each in row.changes if not math.isnan(each)), default=0.0)


def _short(constant: Constant) -> str:
    module = constant.key.rpartition(".")[0].rpartition("/")[2]
    return f"{module}.{constant.name}"


def _number(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def _title(family: str) -> str:
    return family.replace("_", " ").capitalize()
