"""Pictures of variants: principal components over the examples', and strips of figures."""

from collections.abc import Sequence

import numpy as np
from PIL import Image

from solvers.motion import Motion
from solvers.pictures import StickFigureSettings, draw_stick_figures
from solvers.pictures.canvas import FAINT, INK, Canvas
from solvers.variation.align_examples import positions_in_body_frame

from ..shared.report import BENCHMARK_PICTURES, show

GRAY, RED = (165, 170, 180), (200, 40, 40)
WIDTH, HEIGHT, MARGIN = 420.0, 240.0, 34.0


def draw_components(panels: dict[str, tuple[Sequence[Motion], Sequence[Motion]]]) -> str:
    """Draw the first principal component of examples, red, over variants, gray (fig. 4.5)."""
    canvas = Canvas(WIDTH * 2, HEIGHT * ((len(panels) + 1) // 2))
    for index, (title, (examples, variants)) in enumerate(panels.items()):
        left, top = WIDTH * (index % 2) + MARGIN, HEIGHT * (index // 2) + MARGIN
        curves = [_component(examples, one) for one in (*variants, *examples)]
        low, high = (edge(np.concatenate(curves)) for edge in (np.min, np.max))
        longest = max(len(one) for one in curves)
        canvas.text(left, top - 14.0, title, INK)
        floor = top + HEIGHT - 2 * MARGIN
        canvas.line([(left, floor), (left + WIDTH - 2 * MARGIN, floor)], FAINT)
        for row, curve in enumerate(curves):
            across = left + np.arange(len(curve)) / longest * (WIDTH - 2 * MARGIN)
            up = floor - (curve - low) / (high - low) * (HEIGHT - 2 * MARGIN)
            color = GRAY if row < len(variants) else RED
            canvas.line(list(zip(across, up, strict=True)), color, 1.2)
    return _saved(canvas.picture().pixels, "components", "Components of the variation model")


def draw_strips(name: str, examples: Sequence[Motion], variants: Sequence[Motion]) -> str:
    """Draw two examples and four variants below each other."""
    settings = StickFigureSettings(n_figures=9, height=120)
    shown = [("example", one) for one in examples[:2]] + [
        ("variant", one) for one in variants[:4]
    ]
    strips = [draw_stick_figures({label: one}, settings).pixels for label, one in shown]
    width = max(one.shape[1] for one in strips)
    padded = [
        np.pad(one, ((0, 0), (0, width - one.shape[1]), (0, 0)), constant_values=255)
        for one in strips
    ]
    return _saved(np.concatenate(padded), name.replace(" ", "_"), f"Variants of {name}")


def _component(examples: Sequence[Motion], motion: Motion) -> np.ndarray:
    bodies = np.concatenate([_flat(one) for one in examples])
    axis = np.linalg.svd(bodies - bodies.mean(axis=0), full_matrices=False)[2][0]
    return (_flat(motion) - bodies.mean(axis=0)) @ axis


def _flat(motion: Motion) -> np.ndarray:
    body = positions_in_body_frame(motion)[:: max(round(motion.frame_rate / 30.0), 1)]
    return body.reshape(len(body), -1)


def _saved(pixels: np.ndarray, name: str, title: str) -> str:
    picture = BENCHMARK_PICTURES / "variation" / f"{name}.png"
    picture.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(pixels).save(picture, optimize=True)
    return f"{show(picture, title)}\n"
