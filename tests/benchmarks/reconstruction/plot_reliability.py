"""A picture for the document: what reliability said of a take, and how wrong it was."""

from pathlib import Path

import numpy as np

from solvers.arrays import Array
from solvers.pictures.canvas import FAINT, INK, Canvas, Color
from solvers.reconstruction import ReliabilityMethod, ReliabilitySettings, measure_reliability

from .part_reliability import Pair

TAKE = "m02_s02_e01"
LEFT, TOP, ROW, GAP, WIDTH = 96.0, 40.0, 13.0, 62.0, 900.0
STEPS: tuple[Color, ...] = ((247, 247, 247), (253, 219, 160), (230, 120, 40), (120, 20, 30))
"""From reliable to unreliable, in equal steps; darker as well as redder."""
DARKEST_ERROR_M = 0.10
"""Error that is as dark as reliability zero, meters."""


def draw_take(pair: Pair, path: Path) -> None:
    """Draw error scores of both methods above the true error, joint by joint."""
    published = ReliabilitySettings(method=ReliabilityMethod.PUBLISHED)
    recording = pair.recording
    panels = {
        "Default: probability of an error above 5 cm": 1.0
        - measure_reliability(recording).combined,
        "As published: 1 - reliability": 1.0
        - measure_reliability(recording, settings=published).combined,
        "True error by the optical system, darkest: 10 cm and more": pair.error
        / DARKEST_ERROR_M,
    }
    height = len(recording.names) * ROW
    canvas = Canvas(LEFT + WIDTH + 30.0, TOP + len(panels) * (height + GAP))
    top = TOP
    for title, values in panels.items():
        canvas.text(LEFT, top - 16.0, title)
        _draw_colors(canvas, values, recording.names, top)
        _draw_seconds(canvas, recording.n_frames, recording.frame_rate, top + height)
        top += height + GAP
    canvas.picture().save(path)


def _draw_colors(canvas: Canvas, values: Array, names: tuple[str, ...], top: float) -> None:
    wide = WIDTH / len(values)
    for joint, name in enumerate(names):
        up = top + joint * ROW
        canvas.text(LEFT - 8.0, up + ROW / 2.0, name, INK, "rm")
        for frame, value in enumerate(values[:, joint]):
            left = LEFT + frame * wide
            canvas.box(left, up, left + wide, up + ROW - 1.0, _color(float(value)))


def _draw_seconds(canvas: Canvas, n_frames: int, frame_rate: float, top: float) -> None:
    for second in np.arange(0.0, n_frames / frame_rate, 0.5):
        x = LEFT + WIDTH * second * frame_rate / n_frames
        canvas.line([(x, top), (x, top + 4.0)], FAINT)
        canvas.text(x, top + 14.0, f"{second:.1f} s", INK, "mm")


def _color(value: float) -> Color:
    if not np.isfinite(value):
        return (255, 255, 255)
    position = float(np.clip(value, 0.0, 1.0)) * (len(STEPS) - 1)
    red, green, blue = (
        round(float(np.interp(position, range(len(STEPS)), [step[part] for step in STEPS])))
        for part in range(3)
    )
    return red, green, blue
