"""Pictures for the document: precision against recall, and confusion matrices."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from solvers.pictures.canvas import FAINT, GRID, INK, Canvas, Color

from ..shared.plots import colors
from .retrieval_protocol import RECALLS, Answer

LEFT, TOP, SIZE, LEGEND, ROW = 60.0, 50.0, 460.0, 320.0, 22.0
CELL, NAMES = 34.0, 230.0
DARK: Color = (0, 90, 181)


def draw_curves(answers: Mapping[str, Sequence[Answer]], title: str, path: Path) -> None:
    """Draw the mean precision at each recall, one line for each method."""
    canvas = Canvas(LEFT + SIZE + LEGEND, TOP + SIZE + 60.0)
    canvas.text(LEFT, 20.0, title)
    for mark in np.linspace(0.0, 1.0, 6):
        x, y = LEFT + mark * SIZE, TOP + (1.0 - mark) * SIZE
        canvas.line([(LEFT, y), (LEFT + SIZE, y)], GRID)
        canvas.line([(x, TOP), (x, TOP + SIZE)], GRID)
        canvas.text(LEFT - 8.0, y, f"{mark:.1f}", FAINT, "rm")
        canvas.text(x, TOP + SIZE + 14.0, f"{mark:.1f}", FAINT, "mm")
    canvas.text(LEFT + SIZE / 2.0, TOP + SIZE + 36.0, "recall; up: precision", FAINT, "mm")
    for index, (name, color) in enumerate(colors(list(answers)).items()):
        curve = np.mean([each.curve for each in answers[name]], axis=0)
        width = 3.5 if name.startswith("ours") else 1.5
        line = np.column_stack([LEFT + RECALLS * SIZE, TOP + (1.0 - curve) * SIZE])
        canvas.line(line, color, width)
        y = TOP + ROW * (index + 0.5)
        canvas.line([(LEFT + SIZE + 20.0, y), (LEFT + SIZE + 44.0, y)], color, width)
        canvas.text(LEFT + SIZE + 52.0, y, name)
    path.parent.mkdir(parents=True, exist_ok=True)
    canvas.picture().save(path)


def draw_growth(
    sizes: Sequence[int], columns: Mapping[str, Sequence[float]], title: str, path: Path
) -> None:
    """Draw figures against the size of a library, both in powers of ten."""
    canvas = Canvas(LEFT + SIZE + LEGEND, TOP + SIZE + 60.0)
    canvas.text(LEFT, 20.0, title)
    across = np.log10(np.asarray(sizes, dtype=float))
    up = {name: np.log10(np.asarray(values)) for name, values in columns.items()}
    low, high = np.floor(min(map(np.min, up.values()))), np.ceil(max(map(np.max, up.values())))
    left, right = np.floor(across[0]), np.ceil(across[-1])
    for mark in np.arange(low, high + 1.0):
        y = TOP + SIZE * (high - mark) / (high - low)
        canvas.line([(LEFT, y), (LEFT + SIZE, y)], GRID)
        canvas.text(LEFT - 8.0, y, f"{10**mark:,.6g}", FAINT, "rm")
    for mark in np.arange(left, right + 1.0):
        x = LEFT + SIZE * (mark - left) / (right - left)
        canvas.line([(x, TOP), (x, TOP + SIZE)], GRID)
        canvas.text(x, TOP + SIZE + 14.0, f"{10**mark:,.0f}", FAINT, "mm")
    canvas.text(LEFT + SIZE / 2.0, TOP + SIZE + 36.0, "clips", FAINT, "mm")
    for index, (name, color) in enumerate(colors(list(columns)).items()):
        x = LEFT + SIZE * (across - left) / (right - left)
        canvas.line(
            np.column_stack([x, TOP + SIZE * (high - up[name]) / (high - low)]), color, 2.5
        )
        y = TOP + ROW * (index + 0.5)
        canvas.line([(LEFT + SIZE + 20.0, y), (LEFT + SIZE + 44.0, y)], color, 2.5)
        canvas.text(LEFT + SIZE + 52.0, y, name)
    path.parent.mkdir(parents=True, exist_ok=True)
    canvas.picture().save(path)


def draw_confusion(answers: Sequence[Answer], title: str, path: Path) -> None:
    """Draw what classes were found first, for queries of each class: a row each."""
    labels = sorted({each.label for each in answers})
    every = sorted({label for each in answers for label in each.found} | set(labels))
    canvas = Canvas(NAMES + CELL * len(every) + 20.0, TOP + CELL * len(labels) + 170.0)
    canvas.text(LEFT, 20.0, title)
    for row, label in enumerate(labels):
        up = TOP + row * CELL
        canvas.text(NAMES - 8.0, up + CELL / 2.0, label, INK, "rm")
        mine = [each.found for each in answers if each.label == label]
        for column, other in enumerate(every):
            fraction = float(np.mean([found.get(other, 0.0) for found in mine]))
            left = NAMES + column * CELL
            canvas.box(left, up, left + CELL - 1.0, up + CELL - 1.0, _shade(fraction))
            if fraction >= 0.005:
                ink = (255, 255, 255) if fraction > 0.5 else INK
                words = f"{fraction:.2f}".lstrip("0")
                canvas.text(left + CELL / 2.0, up + CELL / 2.0, words, ink, "mm")
    bottom = TOP + len(labels) * CELL
    for column, other in enumerate(every):
        x, lower = NAMES + (column + 0.5) * CELL, 16.0 * (column % 9)
        canvas.line([(x, bottom + 2.0), (x, bottom + 8.0 + lower)], GRID)
        canvas.text(x, bottom + 16.0 + lower, other, FAINT, "mm")
    path.parent.mkdir(parents=True, exist_ok=True)
    canvas.picture().save(path)


def _shade(fraction: float) -> Color:
    red, green, blue = (round(250 + fraction * (part - 250)) for part in DARK)
    return red, green, blue
