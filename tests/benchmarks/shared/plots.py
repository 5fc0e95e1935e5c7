"""Scores as a picture: one line for each method, the columns from left to right."""

from colorsys import hsv_to_rgb
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from solvers.pictures.canvas import FAINT, GRID, INK, Canvas

from .tables import Scores, number

WIDTH, LEFT, RIGHT, TOP, BOTTOM, ROW = 1180, 60.0, 420.0, 50.0, 50.0, 22.0
MIN_HEIGHT_PX = 420
MAX_SCALE_RATIO = 2.5
"""The scale ends at this multiple of our worst figure; larger ones are cut off at the top."""
Color = tuple[int, int, int]


def draw_scores(scores: Scores, path: Path) -> None:
    """Write the means over clips to a PNG file; ours are black and gray."""
    height = max(MIN_HEIGHT_PX, TOP + BOTTOM + ROW * len(scores.methods))
    canvas = Canvas(WIDTH, height)
    across = np.linspace(LEFT + 20, WIDTH - RIGHT, max(len(scores.columns), 2))
    axis = _Axis(height - BOTTOM, _top(scores))
    canvas.text(LEFT, 20.0, f"{scores.title} ({scores.unit})")
    for mark in axis.marks():
        y = axis.height(mark)
        canvas.line([(LEFT, y), (WIDTH - RIGHT + 20, y)], GRID)
        canvas.text(LEFT - 8.0, y, number(mark), FAINT, "rm")
    for index, (x, column) in enumerate(zip(across, scores.columns, strict=False)):
        lower = 14.0 * (index % 2) if len(scores.columns) > 6 else 0.0
        canvas.text(x, axis.bottom + 14.0 + lower, column, FAINT, "mm")
    for index, (name, color) in enumerate(colors(scores.methods).items()):
        width = 3.5 if name.startswith("ours") else 1.5
        for run in _runs(scores, name, across, axis):
            if len(run) > 1:
                canvas.line(run, color, width)
            for point in run:
                canvas.dot(point, color, width + 1.0)
        y = TOP + ROW * (index + 0.5)
        canvas.line([(WIDTH - RIGHT + 40, y), (WIDTH - RIGHT + 64, y)], color, width)
        canvas.text(WIDTH - RIGHT + 72.0, y, name, INK, "lm")
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(canvas.picture().pixels).save(path, optimize=True)


class _Axis:
    def __init__(self, bottom: float, top: float) -> None:
        self.bottom, self.top = bottom, top

    def height(self, value: float) -> float:
        return self.bottom - (self.bottom - TOP) * value / self.top

    def marks(self) -> NDArray[np.float64]:
        step = 10.0 ** np.floor(np.log10(self.top / 2))
        while self.top / step > 8:
            step *= 2
        return np.arange(0.0, self.top, step)


def _top(scores: Scores) -> float:
    def worst(methods: list[str]) -> float:
        means = [scores.mean(name, column) for name in methods for column in scores.columns]
        return float(np.nanmax(means))

    mine = [name for name in scores.methods if name == scores.ours] or scores.methods
    return 1.05 * min(worst(scores.methods), MAX_SCALE_RATIO * worst(mine))


def _runs(
    scores: Scores, name: str, across: NDArray[np.float64], axis: _Axis
) -> list[list[tuple[float, float]]]:
    """Points of a method, cut where the table's columns do not follow from each other."""
    runs: list[list[tuple[float, float]]] = [[]]
    for x, column in zip(across, scores.columns, strict=False):
        value = scores.mean(name, column)
        if column in scores.breaks or not value <= axis.top:
            runs.append([])
        if value <= axis.top:
            runs[-1].append((float(x), axis.height(value)))
    return [run for run in runs if run]


def colors(methods: list[str]) -> dict[str, Color]:
    greys = iter([INK, FAINT, FAINT])
    others = [name for name in methods if not name.startswith("ours")]
    hues = {name: index / max(len(others), 1) for index, name in enumerate(others)}
    found: dict[str, Color] = {}
    for index, name in enumerate(methods):
        if name in hues:
            red, green, blue = hsv_to_rgb(hues[name], 0.75, 0.85 if index % 2 else 0.6)
            found[name] = (round(255 * red), round(255 * green), round(255 * blue))
        else:
            found[name] = next(greys)
    return found
