"""A small table as a picture."""

from collections.abc import Sequence

from ..errors import InvalidMotionError
from .canvas import FAINT, GRID, INK, Canvas
from .picture import Picture

ROW, MARGIN, BETWEEN = 26.0, 16.0, 28.0


def draw_table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> Picture:
    """Draw text in columns: the first to the left, the others, figures mostly, to the right.

    Parameters
    ----------
    head : titles of the columns
    rows : as many words each as there are titles

    Returns
    -------
    Picture

    Raises
    ------
    InvalidMotionError
        A row is longer or shorter than the head.
    """
    if any(len(row) != len(head) for row in rows):
        raise InvalidMotionError(f"Every row of the table needs {len(head)} columns.")
    paper = Canvas(1, 1)
    widths = [
        max(paper.text_width(words) for words in column)
        for column in zip(head, *rows, strict=True)
    ]
    width = sum(widths) + BETWEEN * (len(head) - 1)
    canvas = Canvas(width + 2 * MARGIN, ROW * (len(rows) + 1) + 2 * MARGIN)
    for number, row in enumerate([head, *rows]):
        middle = MARGIN + ROW * (number + 0.5)
        x = MARGIN
        for column, words in enumerate(row):
            if column == 0:
                canvas.text(x, middle, words, INK, "lm")
            else:
                canvas.text(x + widths[column], middle, words, INK, "rm")
            x += widths[column] + BETWEEN
        under = FAINT if number == 0 else GRID
        canvas.line([(MARGIN, middle + ROW / 2), (MARGIN + width, middle + ROW / 2)], under)
    return canvas.picture()
