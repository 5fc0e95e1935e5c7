"""Scores as a picture: one line for each method, the columns from left to right."""

from pathlib import Path

import numpy as np
from PIL import Image

from solvers.pictures.canvas import FAINT, GRID, INK, Canvas, series_colors

from .tables import Scores, number

WIDTH, HEIGHT = 1100, 460
LEFT, RIGHT, TOP, BOTTOM = 60.0, 420.0, 50.0, 50.0
CEILING = 2.5
"""The scale ends at this multiple of our worst figure: what is far off runs out at the top."""


def draw_scores(scores: Scores, path: Path) -> None:
    """Write the means over clips as lines to a PNG file."""
    canvas = Canvas(WIDTH, HEIGHT)
    means = {name: _means(scores, name) for name in scores.methods}
    ours = means.get(scores.ours, np.concatenate(list(means.values())))
    everything = np.concatenate(list(means.values()))
    top = min(np.nanmax(everything), CEILING * np.nanmax(ours)) * 1.05
    canvas.text(LEFT, 20.0, f"{scores.title} ({scores.unit})")
    across = np.linspace(LEFT + 20, WIDTH - RIGHT, max(len(scores.columns), 2))
    for mark in _ticks(top):
        y = _height(mark, top)
        canvas.line([(LEFT, y), (WIDTH - RIGHT + 20, y)], GRID)
        canvas.text(LEFT - 8.0, y, number(mark), FAINT, "rm")
    for x, column in zip(across, scores.columns, strict=False):
        canvas.text(x, HEIGHT - BOTTOM + 18.0, column[:18], FAINT, "mm")
    colors = series_colors(len(means))
    for place, ((name, values), color) in enumerate(zip(means.items(), colors, strict=True)):
        mine = name.startswith("ours")
        points = [
            (x, _height(v, top)) for x, v in zip(across, values, strict=False) if v <= top
        ]
        if len(points) > 1:
            canvas.line(points, color, 3.0 if mine else 1.5)
        for point in points:
            canvas.dot(point, color, 4.0 if mine else 2.5)
        y = TOP + 10.0 + 22.0 * place
        canvas.line([(WIDTH - RIGHT + 40, y), (WIDTH - RIGHT + 64, y)], color, 3.0)
        canvas.text(WIDTH - RIGHT + 72.0, y, name, INK, "lm")
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(canvas.picture().pixels).save(path, optimize=True)


def _means(scores: Scores, method: str) -> np.ndarray:
    return np.array([scores.mean(method, column) for column in scores.columns])


def _height(value: float, top: float) -> float:
    return HEIGHT - BOTTOM - (HEIGHT - BOTTOM - TOP) * value / top


def _ticks(top: float) -> np.ndarray:
    step = 10.0 ** np.floor(np.log10(top / 2))
    while top / step > 8:
        step *= 2
    return np.arange(0.0, top, step)
