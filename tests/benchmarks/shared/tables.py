"""Scores of many methods on many clips, as tables in Markdown."""

import textwrap
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

LINE_WIDTH = 140
"""Characters in a line of a page, tables aside."""


class Scores:
    """Figures by method, column and clip."""

    def __init__(self, title: str, unit: str, ours: str = "ours") -> None:
        self.title, self.unit, self.ours = title, unit, ours
        self._found: dict[tuple[str, str], dict[str, float]] = defaultdict(dict)
        self.methods: list[str] = []
        self.columns: list[str] = []
        self.breaks: set[str] = set()
        """Columns that do not follow from the one before them."""

    def add(
        self, method: str, column: object, clip: str, figure: float, follows: bool = True
    ) -> None:
        """Note one figure; `follows` is false where a new row of columns begins."""
        column = str(column)
        if not follows:
            self.breaks.add(column)
        if method not in self.methods:
            self.methods.append(method)
        if column not in self.columns:
            self.columns.append(column)
        self._found[method, column][clip] = figure

    def add_overall(self) -> None:
        """Add a last column "all" over the clips of all columns."""
        for method in self.methods:
            for column in self.columns:
                for clip, figure in self._found[method, column].items():
                    self._found[method, "all"][f"{column} {clip}"] = figure
        self.columns.append("all")
        self.breaks.add("all")

    def mean(self, method: str, column: str) -> float:
        """Mean over clips."""
        return _quietly(np.mean, self._found[method, column].values())

    def spread(self, method: str, column: str) -> float:
        """Standard deviation over clips."""
        return _quietly(np.std, self._found[method, column].values())

    def paired(self, method: str, column: str) -> tuple[float, float]:
        """Mean and standard deviation over clips of this method's figure less ours."""
        ours = self._found[self.ours, column]
        other = self._found[method, column]
        differences = [other[clip] - ours[clip] for clip in other if clip in ours]
        return _quietly(np.mean, differences), _quietly(np.std, differences)

    def markdown(self) -> str:
        """Mean ± spread, then the paired difference to ours; of one clip each, the figures."""
        statistic = "" if self._is_single else "; mean ± standard deviation over clips"
        parts = [f"**{self.title}** ({self.unit}{statistic})\n"]
        rows = {name: [self._cell(name, one) for one in self.columns] for name in self.methods}
        parts.append(table(["method", *self.columns], rows))
        if self.ours in self.methods and len(self.methods) > 1:
            others = [name for name in self.methods if name != self.ours]
            rows = {name: [self._pair(name, one) for one in self.columns] for name in others}
            parts.append(
                f"\nThe same clip by clip, method less {self.ours} (+ is worse than it)\n"
            )
            parts.append(table(["method", *self.columns], rows))
        return "\n".join(parts) + "\n"

    def _cell(self, method: str, column: str) -> str:
        if not np.isfinite(self.mean(method, column)):
            return "-"
        mean = number(self.mean(method, column))
        is_single = len(self._found[method, column]) == 1
        return mean if is_single else f"{mean} ± {number(self.spread(method, column))}"

    def _pair(self, method: str, column: str) -> str:
        mean, spread = self.paired(method, column)
        if not np.isfinite(mean):
            return "-"
        difference = f"{'+' if mean >= 0 else '-'}{number(abs(mean))}"
        is_single = len(self._found[method, column]) == 1
        return difference if is_single else f"{difference} ± {number(spread)}"

    @property
    def _is_single(self) -> bool:
        """Whether no figure is that of more than one clip."""
        return all(len(clips) <= 1 for clips in self._found.values())


def table(header: Sequence[str], rows: dict[str, list[str]]) -> str:
    """Return a Markdown table, padded so that it reads well as plain text too."""
    lines = [list(header), *([name, *cells] for name, cells in rows.items())]
    widths = [max(len(line[index]) for line in lines) for index in range(len(header))]
    padded = [
        "| " + " | ".join(cell.ljust(w) for cell, w in zip(line, widths, strict=True)) + " |"
        for line in lines
    ]
    rule = "|" + "|".join("-" * (w + 2) for w in widths) + "|"
    return "\n".join([padded[0], rule, *padded[1:]])


def wrapped(text: str) -> str:
    """Return Markdown with its sentences wrapped; tables and pictures stay on one line."""
    return "\n".join(
        line
        if line.startswith(("|", "!["))
        else textwrap.fill(
            line,
            LINE_WIDTH,
            subsequent_indent="  " if line.startswith("- ") else "",
            break_long_words=False,
            break_on_hyphens=False,
        )
        for line in text.split("\n")
    )


def number(value: float) -> str:
    """Three figures that matter."""
    if not np.isfinite(value):
        return "-"
    return f"{value:.0f}" if value >= 100 else f"{value:.1f}" if value >= 10 else f"{value:.2f}"


def _quietly(statistic: Callable[[list[float]], Any], figures: Iterable[float]) -> float:
    """Return the statistic, or NaN where there is no figure."""
    given = list(figures)
    return float(statistic(given)) if given else float("nan")
