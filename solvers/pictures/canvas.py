"""Draw smooth lines and readable text at pixel coordinates."""

from collections.abc import Sequence
from math import isfinite, nan
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
"""First raw, in a warm color, then clean, in a cool one; distinguishable for color-blind
readers (Okabe and Ito 2008, Color Universal Design, with a deeper blue)."""

OVERSAMPLING = 3
"""Drawn this many times larger and averaged, which smooths the edges."""
TEXT_SIZE_PX = 14


class Canvas:
    """A white canvas; x to the right and y down, in pixels from the top left corner."""

    def __init__(self, width: float, height: float) -> None:
        from PIL import Image, ImageDraw, ImageFont

        size = (round(width) * OVERSAMPLING, round(height) * OVERSAMPLING)
        self._image = Image.new("RGB", size, (255, 255, 255))
        self._draw = ImageDraw.Draw(self._image)
        self._font: Any = ImageFont.load_default(TEXT_SIZE_PX * OVERSAMPLING)

    def line(self, points: ArrayLike, color: Color, width: float = 1.0) -> None:
        """Draw a line through points, shape (n, 2), with round ends; it breaks at NaN."""
        run: list[tuple[float, float]] = []
        for x, y in [*np.asarray(points, dtype=np.float64).tolist(), (nan, nan)]:
            if isfinite(x) and isfinite(y):
                run.append((x, y))
            elif run:
                self._stroke(run, color, width)
                run = []

    def _stroke(self, points: list[tuple[float, float]], color: Color, width: float) -> None:
        if len(points) > 1:
            flat = [(x * OVERSAMPLING, y * OVERSAMPLING) for x, y in points]
            stroke = max(1, round(width * OVERSAMPLING))
            self._draw.line(flat, fill=color, width=stroke, joint="curve")
        for end in (points[0], points[-1]):
            self._disk(*end, color, width / 2.0)

    def dot(self, center: ArrayLike, color: Color, radius: float) -> None:
        """Fill a circle; nothing if the center is NaN."""
        x, y = np.asarray(center, dtype=np.float64).tolist()
        if isfinite(x) and isfinite(y):
            self._disk(x, y, color, radius)

    def _disk(self, x: float, y: float, color: Color, radius: float) -> None:
        x, y, radius = x * OVERSAMPLING, y * OVERSAMPLING, radius * OVERSAMPLING
        self._draw.ellipse([x - radius, y - radius, x + radius, y + radius], fill=color)

    def box(self, left: float, top: float, right: float, bottom: float, color: Color) -> None:
        """Fill a rectangle."""
        corners = [
            left * OVERSAMPLING,
            top * OVERSAMPLING,
            right * OVERSAMPLING - 1,
            bottom * OVERSAMPLING - 1,
        ]
        self._draw.rectangle(corners, fill=color)

    def text(
        self, x: float, y: float, text: str, color: Color = INK, anchor: str = "lm"
    ) -> None:
        """Write one line; the anchor is one of l m r (horizontal) and one of t m b
        (vertical)."""
        vertical_anchors = {"t": "a", "m": "m", "b": "d"}
        self._draw.text(
            (x * OVERSAMPLING, y * OVERSAMPLING), text, fill=color, font=self._font,
            anchor=anchor[0] + vertical_anchors[anchor[1]],
        )  # fmt: skip

    def text_width(self, text: str) -> float:
        """Return the width of a line of text in pixels."""
        return float(self._font.getlength(text)) / OVERSAMPLING

    def legend(self, x: float, y: float, labels: Sequence[str]) -> None:
        """Label the series, each after a stroke of its color."""
        for label, color in zip(labels, series_colors(len(labels)), strict=True):
            self.line([(x, y), (x + 22.0, y)], color, 4.0)
            self.text(x + 30.0, y, label)
            x += 54.0 + self.text_width(label)

    def picture(self) -> Picture:
        """Return the drawing."""
        return Picture(np.asarray(self._image.reduce(OVERSAMPLING)))


def series_colors(n_series: int) -> list[Color]:
    """Return one color for each series; a single one gets the color of the clean motion."""
    if n_series == 1:
        return [SERIES[1]]
    return [SERIES[index % len(SERIES)] for index in range(n_series)]


def lighten_color(color: Color, white_fraction: float) -> Color:
    """Return the color mixed with a fraction of white."""
    red, green, blue = (round(channel + white_fraction * (255 - channel)) for channel in color)
    return red, green, blue
