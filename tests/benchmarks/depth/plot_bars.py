"""Scores as bars, one for each method: what each part of a method is worth."""

from pathlib import Path

from solvers.pictures.canvas import FAINT, GRID, INK, SERIES, Canvas

from ..shared.tables import Scores, number

LEFT, TOP, ROW, WIDTH, GAP, RIGHT = 270.0, 64.0, 22.0, 330.0, 60.0, 20.0
MAX_BAR_RATIO = 4.0
"""Bars longer than the first one by this factor are cut off; figures stand next to them."""


def draw_bars(scores: Scores, columns: dict[str, float], path: Path) -> None:
    """Write means over clips to a PNG file; the first method is the one to compare with.

    Parameters
    ----------
    scores : Scores
    columns : dict
        Which columns to draw, and where the bars of each begin.
    path : Path
    """
    default = scores.methods[0]
    wide = LEFT + len(columns) * (WIDTH + GAP) + RIGHT
    canvas = Canvas(wide, TOP + ROW * len(scores.methods) + 20.0)
    canvas.text(16.0, 20.0, scores.title)
    for row, method in enumerate(scores.methods):
        y = TOP + ROW * (row + 0.5)
        canvas.text(LEFT - 10.0, y, method, INK, "rm")
    for index, (column, start) in enumerate(columns.items()):
        left = LEFT + index * (WIDTH + GAP)
        means = [scores.mean(method, column) - start for method in scores.methods]
        most = min(max(means), MAX_BAR_RATIO * means[0])
        words = column + (f", from {start:g}" if start else "")
        cut = f"; bars of more than {MAX_BAR_RATIO:g} times the first are cut off"
        canvas.text(left, 44.0, words + (cut if max(means) > most else ""), FAINT)
        at = left + WIDTH * means[0] / most
        for row, (method, mean) in enumerate(zip(scores.methods, means, strict=True)):
            top = TOP + ROW * row + 3.0
            long = WIDTH * min(max(mean, 0.0) / most, 1.0)
            color = SERIES[1] if method == default else SERIES[0]
            canvas.box(left, top, left + max(long, 1.0), top + ROW - 6.0, color)
            canvas.text(left + long + 6.0, top + ROW / 2.0 - 3.0, number(mean + start))
        bottom = TOP + ROW * len(scores.methods)
        canvas.line([(at, TOP), (at, bottom)], GRID, 1.5)
    path.parent.mkdir(parents=True, exist_ok=True)
    canvas.picture().save(path)
