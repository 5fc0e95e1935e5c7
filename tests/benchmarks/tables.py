"""Scores of many methods on many clips, as tables in Markdown."""

from collections import defaultdict
from collections.abc import Sequence

import numpy as np


class Scores:
    """Figures by method, column and clip."""

    def __init__(self, title: str, unit: str, ours: str = "ours") -> None:
        self.title, self.unit, self.ours = title, unit, ours
        self._found: dict[tuple[str, str], dict[str, float]] = defaultdict(dict)
        self.methods: list[str] = []
        self.columns: list[str] = []

    def add(self, method: str, column: object, clip: str, figure: float) -> None:
        """Note one figure."""
        column = str(column)
        if method not in self.methods:
            self.methods.append(method)
        if column not in self.columns:
            self.columns.append(column)
        self._found[method, column][clip] = figure

    def mean(self, method: str, column: str) -> float:
        """Mean over clips."""
        return float(np.mean(list(self._found[method, column].values())))

    def spread(self, method: str, column: str) -> float:
        """Standard deviation over clips."""
        return float(np.std(list(self._found[method, column].values())))

    def paired(self, method: str, column: str) -> tuple[float, float]:
        """Mean and standard deviation over clips of this method's figure less ours."""
        ours = self._found[self.ours, column]
        other = self._found[method, column]
        differences = [other[clip] - ours[clip] for clip in other if clip in ours]
        return float(np.mean(differences)), float(np.std(differences))

    def markdown(self) -> str:
        """Mean ± spread, then the paired difference to ours."""
        parts = [f"**{self.title}** ({self.unit}; mean ± standard deviation over clips)\n"]
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
        if not self._found[method, column]:
            return "-"
        return f"{number(self.mean(method, column))} ± {number(self.spread(method, column))}"

    def _pair(self, method: str, column: str) -> str:
        if not self._found[method, column] or not self._found[self.ours, column]:
            return "-"
        mean, spread = self.paired(method, column)
        return f"{'+' if mean >= 0 else '-'}{number(abs(mean))} ± {number(spread)}"


def table(header: Sequence[str], rows: dict[str, list[str]]) -> str:
    """Return a Markdown table, padded so that it reads well as plain text too."""
    lines = [list(header), *([name, *cells] for name, cells in rows.items())]
    widths = [max(len(line[place]) for line in lines) for place in range(len(header))]
    padded = [
        "| " + " | ".join(cell.ljust(w) for cell, w in zip(line, widths, strict=True)) + " |"
        for line in lines
    ]
    rule = "|" + "|".join("-" * (w + 2) for w in widths) + "|"
    return "\n".join([padded[0], rule, *padded[1:]])


def number(value: float) -> str:
    """Three figures that matter."""
    if not np.isfinite(value):
        return "-"
    return f"{value:.0f}" if value >= 100 else f"{value:.1f}" if value >= 10 else f"{value:.2f}"
