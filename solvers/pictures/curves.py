"""Plot rotation channels over time, before and after."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..errors import InvalidMotionError
from ..motion import Motion
from ..rotations import inverse, mean_rotation, multiply, rotation_vector_from_quaternion
from ..settings import Settings, setting
from .canvas import FAINT, GRID, INK, SHADE, Canvas, series_colors
from .picture import Picture

TOP, BOTTOM, LEFT, RIGHT, GAP = 64.0, 40.0, 64.0, 20.0, 30.0

MIN_RANGE_DEG = 2.0
"""Minimum range of a plot in degrees."""


@dataclass(frozen=True, kw_only=True)
class CurveSettings(Settings):
    """Size of the plots."""

    width: int = setting(1100, "Width of the image", unit="px", minimum=200, maximum=8000)
    height: int = setting(
        140, "Height of the plot of one joint", unit="px", minimum=40, maximum=2000
    )


def draw_curves(
    motions: Mapping[str, Motion],
    joints: Sequence[str],
    settings: CurveSettings = CurveSettings(),
) -> Picture:
    """Plot for each joint the component of its rotation that varies most, in degrees.

    It is one component of the rotation vector relative to the joint's mean; the last motion
    determines the component and the mean. Where the first motion is missing, its curve breaks
    and the background is shaded.

    Parameters
    ----------
    motions : mapping from label to Motion
        The last one, the clean one, is on top.
    joints : names of joints that all motions have
    settings : CurveSettings

    Returns
    -------
    Picture

    Raises
    ------
    InvalidMotionError
        There is nothing to draw, or a motion lacks one of the joints.
    """
    if not motions or not joints:
        raise InvalidMotionError("Curves need at least one motion and one joint.")
    height = TOP + BOTTOM + len(joints) * (settings.height + GAP) - GAP
    canvas = Canvas(settings.width, height)
    canvas.legend(LEFT, 20.0, list(motions))
    longest = max((motion.n_frames - 1) * motion.dt for motion in motions.values())
    for row, joint in enumerate(joints):
        top = TOP + row * (settings.height + GAP)
        curves, name = _moving_component(motions, joint)
        axes = _Axes(
            LEFT, top, settings.width - RIGHT, top + settings.height, max(longest, 1e-9),
            *_limits(curves),
        )  # fmt: skip
        canvas.text(axes.left + 6.0, axes.top - 11.0, name)
        _draw_plot(canvas, axes, [motion.dt for motion in motions.values()], curves)
    for second in ticks(0.0, longest):
        canvas.text(float(axes.x(second)), axes.bottom + 16.0, f"{second:g} s", INK, "mm")
    return canvas.picture()


def ticks(low: float, high: float, max_ticks: int = 10) -> list[float]:
    """Return round numbers from `low` to `high`, at most `max_ticks`, evenly spaced."""
    width = max(high - low, 1e-9)
    power = 10.0 ** np.floor(np.log10(width / max_ticks))
    step = next(
        power * factor
        for factor in (1.0, 2.0, 5.0, 10.0)
        if width / (power * factor) < max_ticks
    )
    first, last = np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9)
    return [float(round(step * count, 9)) + 0.0 for count in np.arange(first, last + 1)]


class _Axes(NamedTuple):
    """Position of a plot on the canvas, and its ranges: seconds across, degrees up."""

    left: float
    top: float
    right: float
    bottom: float
    longest: float
    low: float
    high: float

    def x(self, seconds: ArrayLike) -> Array:
        return self.left + np.asarray(seconds) / self.longest * (self.right - self.left)

    def y(self, degrees: ArrayLike) -> Array:
        fraction = (np.asarray(degrees) - self.low) / (self.high - self.low)
        return np.asarray(self.bottom - fraction * (self.bottom - self.top))


def _draw_plot(
    canvas: Canvas, axes: _Axes, steps: Sequence[float], curves: Sequence[Array]
) -> None:
    for frame in np.flatnonzero(np.isnan(curves[0])):
        frame_limits = np.array([frame - 0.5, frame + 0.5]) * steps[0]
        left, right = axes.x(np.clip(frame_limits, 0.0, axes.longest)).tolist()
        canvas.box(left, axes.top, right, axes.bottom, SHADE)
    for level in ticks(axes.low, axes.high, 4):
        height = float(axes.y(level))
        canvas.line([(axes.left, height), (axes.right, height)], GRID)
        canvas.text(axes.left - 8.0, height, f"{level:g}°", INK, "rm")
    corner = (axes.left, axes.bottom)
    canvas.line([(axes.left, axes.top), corner, (axes.right, axes.bottom)], FAINT)
    for step, curve, color in zip(steps, curves, series_colors(len(curves)), strict=True):
        x = axes.x(np.arange(len(curve)) * step)
        canvas.line(np.stack([x, axes.y(curve)], axis=-1), color, 1.6)


def _moving_component(motions: Mapping[str, Motion], joint: str) -> tuple[list[Array], str]:
    """Return one component of a joint's rotation in all motions, degrees, and its label."""
    rotations = [
        motion.rotations[:, motion.skeleton.index(joint)] for motion in motions.values()
    ]
    inverse_mean = inverse(mean_rotation(rotations[-1]))
    vectors = [
        np.degrees(rotation_vector_from_quaternion(multiply(inverse_mean, rotation)))
        for rotation in rotations
    ]
    observed = vectors[-1][np.isfinite(vectors[-1]).all(axis=1)]
    component = int(np.argmax(observed.std(axis=0))) if len(observed) else 0
    return [vector[:, component] for vector in vectors], f"{joint}, {'xyz'[component]}"


def _limits(curves: Sequence[Array]) -> tuple[float, float]:
    finite = np.concatenate([curve[np.isfinite(curve)] for curve in curves])
    if not len(finite):
        return -MIN_RANGE_DEG / 2.0, MIN_RANGE_DEG / 2.0
    low, high = float(finite.min()), float(finite.max())
    padding = max(MIN_RANGE_DEG - (high - low), 0.0) / 2.0
    return low - padding, high + padding
