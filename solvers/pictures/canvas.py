"""A sheet to draw on: smooth lines and readable text at pixel coordinates."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .picture import Picture

Color = tuple[int, int, int]

INK: Color = (40, 40, 40)
FAINT: Color = (150, 150, 150)
GRID: Color = (228, 228, 228)
SHADE: Color = (246, 238, 226)
SERIES: tuple[Color, ...] = ((213, 94, 0), (0, 90, 181), (0, 140, 100), (150, 80, 160))
"""First raw, in a warm colour, then clean, in a cool one; told apart by colour-blind readers
too (Okabe and Ito 2008, Color Universal Design, with a deeper blue)."""

FINENESS = 3
"""Drawn that many times larger and averaged, which smooths the edges."""
TEXT_SIZE = 14


class Canvas:
    """White paper; x to the right and y down, in pixels from the top left corner."""

    def __init__(self, width: float, height: float) -> None:
        from PIL import Image, ImageDraw, ImageFont

        size = (round(width) * FINENESS, round(height) * FINENESS)
        self._image = Image.new("RGB", size, (255, 255, 255))
        self._draw = ImageDraw.Draw(self._image)
        self._font: Any = ImageFont.load_default(TEXT_SIZE * FINENESS)

    def line(self, points: ArrayLike, color: Color, width: float = 1.0) -> None:
        """Draw through points, shape (n, 2), with round ends; it breaks where one is NaN."""
        points = np.asarray(points, dtype=np.float64)
        known = np.isfinite(points).all(axis=1)
        starts = np.flatnonzero(known & ~np.concatenate([[False], known[:-1]]))
        stops = np.flatnonzero(known & ~np.concatenate([known[1:], [False]]))
        for start, stop in zip(starts, stops, strict=True):
            piece = points[start : stop + 1]
            flat = [tuple(point) for point in (piece * FINENESS).tolist()]
            if len(flat) > 1:
                stroke = max(1, round(width * FINENESS))
                self._draw.line(flat, fill=color, width=stroke, joint="curve")
            for end in (piece[0], piece[-1]):
                self.dot(end, color, width / 2.0)

    def dot(self, center: ArrayLike, color: Color, radius: float) -> None:
        """Fill a circle; nothing where the centre is NaN."""
        center, reach = np.asarray(center, dtype=np.float64) * FINENESS, radius * FINENESS
        if np.isfinite(center).all():
            box = [*(center - reach), *(center + reach)]
            self._draw.ellipse(box, fill=color)

    def box(self, left: float, top: float, right: float, bottom: float, color: Color) -> None:
        """Fill a rectangle."""
        corners = [left * FINENESS, top * FINENESS, right * FINENESS - 1, bottom * FINENESS - 1]
        self._draw.rectangle(corners, fill=color)

    def text(
        self, x: float, y: float, words: str, color: Color = INK, anchor: str = "lm"
    ) -> None:
        """Write one line; the anchor is one of l m r (across) and one of t m b (down)."""
        place = {"t": "a", "m": "m", "b": "d"}
        self._draw.text(
            (x * FINENESS, y * FINENESS), words, fill=color, font=self._font,
            anchor=anchor[0] + place[anchor[1]],
        )  # fmt: skip

    def text_width(self, words: str) -> float:
        """Return how many pixels a line of text takes."""
        return float(self._font.getlength(words)) / FINENESS

    def legend(self, x: float, y: float, labels: Sequence[str]) -> None:
        """Name the series, each after a stroke of its colour."""
        for label, color in zip(labels, series_colors(len(labels)), strict=True):
            self.line([(x, y), (x + 22.0, y)], color, 4.0)
            self.text(x + 30.0, y, label)
            x += 54.0 + self.text_width(label)

    def picture(self) -> Picture:
        """Return what has been drawn."""
        return Picture(np.asarray(self._image.reduce(FINENESS)))


def series_colors(n_series: int) -> list[Color]:
    """Return one colour for each series; a single one gets the colour of the clean motion."""
    if n_series == 1:
        return [SERIES[1]]
    return [SERIES[index % len(SERIES)] for index in range(n_series)]


def lighten_color(color: Color, share: float) -> Color:
    """Return the colour mixed with a share of white."""
    red, green, blue = (round(part + share * (255 - part)) for part in color)
    return red, green, blue
