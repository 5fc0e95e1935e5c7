"""Draw a small table as a picture."""

from collections.abc import Sequence

from ..errors import InvalidMotionError
from .canvas import FAINT, GRID, INK, Canvas
from .picture import Picture

ROW_HEIGHT_PX, MARGIN_PX, COLUMN_GAP_PX = 26.0, 16.0, 28.0


def draw_table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> Picture:
    """Draw text in columns: the first left-aligned, the others, mostly figures, right-aligned.

    Parameters
    ----------
    head : titles of the columns
    rows : as many texts each as there are titles

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
        max(paper.text_width(text) for text in column)
        for column in zip(head, *rows, strict=True)
    ]
    width = sum(widths) + COLUMN_GAP_PX * (len(head) - 1)
    canvas = Canvas(width + 2 * MARGIN_PX, ROW_HEIGHT_PX * (len(rows) + 1) + 2 * MARGIN_PX)
    for number, row in enumerate([head, *rows]):
        middle = MARGIN_PX + ROW_HEIGHT_PX * (number + 0.5)
        x = MARGIN_PX
        for column, text in enumerate(row):
            if column == 0:
                canvas.text(x, middle, text, INK, "lm")
            else:
                canvas.text(x + widths[column], middle, text, INK, "rm")
            x += widths[column] + COLUMN_GAP_PX
        line_color = FAINT if number == 0 else GRID
        canvas.line(
            [
                (MARGIN_PX, middle + ROW_HEIGHT_PX / 2),
                (MARGIN_PX + width, middle + ROW_HEIGHT_PX / 2),
            ],
            line_color,
        )
    return canvas.picture()
