"""Strips of stick figures: several motions over each other, moment after moment."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import Motion, Skeleton, forward_kinematics
from ..motion.rotations import rotate
from ..settings import Settings, setting
from .canvas import FAINT, INK, Canvas, Color, paler, series_colors
from .picture import Picture

Array = NDArray[np.float64]

TOP, BOTTOM, MARGIN = 44.0, 34.0, 16.0
NARROWEST = 0.35
"""Width of the place of one figure, as a share of its height."""
FARTHEST = 1.3
"""Reach of a figure to either side and upwards for which there is place, in statures."""
SIDEWAYS = 0.02
"""Joints farther than this share of the stature from the middle plane belong to a side."""
BODY = 15
"""A skeleton with at least as many joints is taken for a body, and gets a head."""
STILL = 0.5
"""Seconds over which the direction that the figure faces is averaged."""


class View(Enum):
    """Where the onlooker stands. The view turns with the body."""

    SIDE = "side"
    FRONT = "front"
    QUARTER = "quarter"


AZIMUTH = {View.SIDE: 0.0, View.FRONT: np.pi / 2, View.QUARTER: np.pi / 4}


@dataclass(frozen=True, kw_only=True)
class StickFigureSettings(Settings):
    """What of a motion is drawn, and how large."""

    n_figures: int = setting(8, "Moments drawn, evenly spaced", minimum=1, maximum=200)
    view: View = setting(View.SIDE, "Where the onlooker stands")
    height: int = setting(
        260, "Height of a figure; more shows more", unit="px", minimum=40, maximum=2000
    )


def draw_stick_figures(
    motions: Mapping[str, Motion],
    settings: StickFigureSettings = StickFigureSettings(),
    *,
    frames: range | None = None,
) -> Picture:
    """Draw motions over each other, the last one on top, at evenly spaced moments.

    Each moment stands in its own place from left to right, with the floor (z = 0) as a line.
    The limbs of the left side (+X in the rest pose) are paler. A joint that is not observed,
    and what hangs on it, is not drawn. The onlooker moves and turns with the last motion, for
    which there is place; figures of the others may reach beyond theirs.

    Parameters
    ----------
    motions : mapping from label to Motion
        All with the same number of frames; labels and colours go into the legend.
    settings : StickFigureSettings
    frames : range, optional
        The part to draw from; all by default.

    Returns
    -------
    Picture

    Raises
    ------
    InvalidMotionError
        There is nothing to draw, or the motions do not have the same number of frames.
    """
    shown = _shown_frames(motions, settings.n_figures, frames)
    last = list(motions.values())[-1]
    center, heading = _onlooker(last, shown)
    moments = [
        motion.with_poses(motion.rotations[shown], motion.root_positions[shown])
        for motion in motions.values()
    ]
    points = [
        project(forward_kinematics(motion).positions - center, heading, settings.view)
        for motion in moments
    ]
    tall = max(_stature(motion.skeleton) for motion in motions.values())
    scale = settings.height / tall
    half, top = _extent(points[-1], tall)
    place = max(2.0 * half * scale, NARROWEST * settings.height) + MARGIN
    floor = TOP + MARGIN + top * scale
    canvas = Canvas(max(place * len(shown), 360.0) + 2 * MARGIN, floor + BOTTOM + MARGIN)
    canvas.legend(MARGIN, TOP / 2.0, list(motions))
    canvas.line([(MARGIN, floor), (MARGIN + place * len(shown), floor)], FAINT, 1.0)
    for moment, frame in enumerate(shown):
        middle = MARGIN + (moment + 0.5) * place
        canvas.text(middle, floor + 18.0, f"{frame * last.dt:.2f} s", INK, "mm")
        colors = series_colors(len(motions))
        for motion, spots, color in zip(motions.values(), points, colors, strict=True):
            spot = spots[moment] * (scale, -scale, 1.0) + (middle, floor, 0.0)
            _draw_figure(canvas, motion, spot, color, settings.height)
    return canvas.picture()


def project(positions: Array, heading: Array, view: View) -> Array:
    """Return what the onlooker sees: to the right, up, and away, in metres.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3), metres
    heading : shape (n_frames,), radians
        Direction that the body faces about Z; 0 is -Y. From the side it faces right; from the
        front its left side (+X at heading 0) is on the right.
    view : View
    """
    forward = np.stack([np.sin(heading), -np.cos(heading), 0.0 * heading], axis=-1)
    left = np.stack([np.cos(heading), np.sin(heading), 0.0 * heading], axis=-1)
    turn = AZIMUTH[view]
    right = np.cos(turn) * forward + np.sin(turn) * left
    away = np.cos(turn) * left - np.sin(turn) * forward
    across = np.einsum("fjk,fk->fj", positions, right)
    depth = np.einsum("fjk,fk->fj", positions, away)
    return np.stack([across, positions[..., 2], depth], axis=-1)


def _shown_frames(
    motions: Mapping[str, Motion], n_figures: int, frames: range | None
) -> NDArray[np.intp]:
    lengths = {motion.n_frames for motion in motions.values()}
    if len(lengths) != 1:
        raise InvalidMotionError(
            f"The motions to draw must be as long as each other, not {sorted(lengths)} frames."
        )
    within = frames if frames is not None else range(lengths.pop())
    n_figures = min(n_figures, len(within))
    if not n_figures:
        raise InvalidMotionError("There is no frame to draw.")
    steps = np.linspace(0, len(within) - 1, n_figures)
    return np.array([within[round(step)] for step in steps], dtype=np.intp)


def _onlooker(motion: Motion, shown: NDArray[np.intp]) -> tuple[Array, Array]:
    """Where the body is on the floor, shape (n, 1, 3), and which way it faces, shape (n,)."""
    place = motion.root_positions
    facing = rotate(motion.rotations[:, 0], [0.0, -1.0, 0.0])[:, :2]
    reach = round(STILL / 2.0 * motion.frame_rate)
    center, heading = np.zeros((len(shown), 1, 3)), np.zeros(len(shown))
    for moment, frame in enumerate(shown):
        near = slice(max(frame - reach, 0), frame + reach + 1)
        known = place[near][np.isfinite(place[near]).all(axis=1)]
        # A long gap in the root: keep to the last place that was known.
        center[moment, 0, :2] = (
            known.mean(axis=0)[:2] if len(known) else center[moment - 1, 0, :2]
        )
        sideways, back = np.nansum(facing[near], axis=0)
        heading[moment] = np.arctan2(sideways, -back)
    return center, heading


def _stature(skeleton: Skeleton) -> float:
    """Greatest extent of the rest pose along an axis, metres; 1 for a single point."""
    return float(np.ptp(skeleton.rest_positions, axis=0).max()) or 1.0


def _extent(points: Array, tall: float) -> tuple[float, float]:
    """Greatest distance to a side and above the floor; a pose thrown far off does not count."""
    seen = points[..., :2][np.isfinite(points[..., :2]).all(axis=-1)]
    half, top = (np.abs(seen[:, 0]).max(), seen[:, 1].max()) if len(seen) else (0.0, tall)
    return float(min(half, FARTHEST * tall)), float(np.clip(top, tall, FARTHEST * tall))


def _draw_figure(
    canvas: Canvas, motion: Motion, spots: Array, color: Color, height: float
) -> None:
    """Bones from the farthest to the nearest."""
    skeleton = motion.skeleton
    width = max(height / 70.0, 1.5)
    is_left = skeleton.rest_positions[:, 0] > SIDEWAYS * _stature(skeleton)
    bones = [(joint, parent) for joint, parent in enumerate(skeleton.parents) if parent >= 0]
    depth = np.nan_to_num(spots[:, 2])
    for joint, parent in sorted(bones, key=lambda bone: -depth[list(bone)].sum()):
        shade = paler(color, 0.55) if is_left[joint] else color
        canvas.line(spots[[parent, joint], :2], shade, width)
    if skeleton.n_joints >= BODY:
        top = int(np.argmax(skeleton.rest_positions[:, 2]))
        middle = spots[[top, skeleton.parents[top]], :2].mean(axis=0)
        canvas.dot(middle, color, height / 20.0)
