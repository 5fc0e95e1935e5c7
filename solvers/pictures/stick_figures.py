"""Strips of stick figures: several recordings over each other, moment after moment."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import JointRecording, Motion, Skeleton, Tracks, forward_kinematics
from ..rotations import rotate
from ..settings import Choice, Settings, setting
from .canvas import FAINT, INK, Canvas, Color, paler, series_colors
from .picture import Picture

Array = NDArray[np.float64]
Recording = Motion | Tracks | JointRecording

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


class View(Choice):
    """Where the onlooker stands. The view turns with the body."""

    SIDE = "side", "See the body from its side"
    FRONT = "front", "See the body from the front"
    QUARTER = "quarter", "See the body from between side and front"


AZIMUTH = {View.SIDE: 0.0, View.FRONT: np.pi / 2, View.QUARTER: np.pi / 4}


@dataclass(frozen=True, kw_only=True)
class StickFigureSettings(Settings):
    """What of a motion is drawn, and how large."""

    n_figures: int = setting(8, "Moments drawn, evenly spaced", minimum=1, maximum=200)
    view: View = setting(View.SIDE, "Where the onlooker stands")
    height: int = setting(
        260, "Height of a figure; more shows more", unit="px", minimum=40, maximum=2000
    )


class _Figure(NamedTuple):
    """A recording as it is drawn."""

    points: Array
    """Shape (n_moments, n_points, 3), metres."""
    bones: tuple[tuple[int, int], ...]
    """Joint and parent; none where the points have no skeleton."""
    is_left: NDArray[np.bool_]
    stature: float
    head: tuple[int, int] | None
    """The joint that rests highest, and its parent, of whoever has as many joints as a body."""


def draw_stick_figures(
    recordings: Mapping[str, Recording],
    settings: StickFigureSettings = StickFigureSettings(),
    *,
    frames: range | None = None,
) -> Picture:
    """Draw recordings over each other, the last one on top, at evenly spaced moments.

    Each moment stands in its own place from left to right, with the floor (z = 0) as a line.
    The limbs of the left side (+X in the rest pose) are paler; points without a skeleton are
    dots. A joint that is not observed, and what hangs on it, is not drawn. The onlooker moves
    and turns with the last recording, for which there is place; figures of the others may reach
    beyond theirs.

    Parameters
    ----------
    recordings : mapping from label to Motion, Tracks or JointRecording
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
        There is nothing to draw, or the recordings do not have the same number of frames.
    """
    shown = _shown_frames(recordings, settings.n_figures, frames)
    last = list(recordings.values())[-1]
    center, heading = _onlooker(last, shown)
    figures = [_figure(recording, shown) for recording in recordings.values()]
    spots = [project(each.points - center, heading, settings.view) for each in figures]
    tall = max(figure.stature for figure in figures)
    scale = settings.height / tall
    half, top = _extent(spots[-1], tall)
    place = max(2.0 * half * scale, NARROWEST * settings.height) + MARGIN
    floor = TOP + MARGIN + top * scale
    canvas = Canvas(max(place * len(shown), 360.0) + 2 * MARGIN, floor + BOTTOM + MARGIN)
    canvas.legend(MARGIN, TOP / 2.0, list(recordings))
    canvas.line([(MARGIN, floor), (MARGIN + place * len(shown), floor)], FAINT, 1.0)
    for moment, frame in enumerate(shown):
        middle = MARGIN + (moment + 0.5) * place
        canvas.text(middle, floor + 18.0, f"{frame / last.frame_rate:.2f} s", INK, "mm")
        colors = series_colors(len(recordings))
        for figure, seen, color in zip(figures, spots, colors, strict=True):
            spot = seen[moment] * (scale, -scale, 1.0) + (middle, floor, 0.0)
            _draw_figure(canvas, figure, spot, color, settings.height)
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
    recordings: Mapping[str, Recording], n_figures: int, frames: range | None
) -> NDArray[np.intp]:
    lengths = {recording.n_frames for recording in recordings.values()}
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


def _figure(recording: Recording, shown: NDArray[np.intp]) -> _Figure:
    if isinstance(recording, JointRecording):
        is_left = np.array(["left" in name.lower() for name in recording.names])
        bones = _bones(recording.parents)
        figure = _figure(recording.tracks, shown)
        return figure._replace(bones=bones, is_left=is_left)
    if isinstance(recording, Tracks):
        points = recording.positions[shown]
        sides = np.zeros(recording.n_points, dtype=np.bool_)
        return _Figure(points, (), sides, _height_of_points(recording), None)
    skeleton = recording.skeleton
    top = int(np.argmax(skeleton.rest_positions[:, 2]))
    moments = recording.with_poses(recording.rotations[shown], recording.root_positions[shown])
    stature = _stature(skeleton)
    return _Figure(
        forward_kinematics(moments).positions,
        _bones(skeleton.parents),
        skeleton.rest_positions[:, 0] > SIDEWAYS * stature,
        stature,
        (top, skeleton.parents[top]) if skeleton.n_joints >= BODY else None,
    )


def _bones(parents: Sequence[int]) -> tuple[tuple[int, int], ...]:
    return tuple((joint, parent) for joint, parent in enumerate(parents) if parent >= 0)


def _onlooker(recording: Recording, shown: NDArray[np.intp]) -> tuple[Array, Array]:
    """Where the body is on the floor, shape (n, 1, 3), and which way it faces, shape (n,)."""
    place, facing = _place_and_facing(recording)
    reach = round(STILL / 2.0 * recording.frame_rate)
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


def _place_and_facing(recording: Recording) -> tuple[Array, Array]:
    """Return the body's place, shape (n_frames, 3), and where it faces, (n_frames, 2).

    Points without a skeleton face the way that they go from the first frame to the last; the
    joints of a depth camera face the camera.
    """
    if isinstance(recording, JointRecording):
        place, _ = _place_and_facing(recording.tracks)
        return place, np.tile((0.0, -1.0), (len(place), 1))
    if isinstance(recording, Motion):
        facing = rotate(recording.rotations[:, 0], [0.0, -1.0, 0.0])
        return recording.root_positions, facing[:, :2]
    seen = recording.visible[..., None]
    counts = np.maximum(seen.sum(axis=1), 1)
    place = np.where(seen, recording.positions, 0.0).sum(axis=1) / counts
    place[~seen.any(axis=(1, 2))] = np.nan
    known = place[np.isfinite(place[:, 0])]
    way = known[-1] - known[0] if len(known) else np.zeros(3)
    return place, np.tile(way[:2], (len(place), 1))


def _stature(skeleton: Skeleton) -> float:
    """Greatest extent of the rest pose along an axis, metres; 1 for a single point."""
    return float(np.ptp(skeleton.rest_positions, axis=0).max()) or 1.0


def _height_of_points(tracks: Tracks) -> float:
    """How high most points are spread, metres; 1 where they are all level."""
    heights = tracks.positions[tracks.visible][:, 2]
    spread = np.quantile(heights, [0.01, 0.99]) if len(heights) else np.zeros(2)
    return float(np.ptp(spread)) or 1.0


def _extent(points: Array, tall: float) -> tuple[float, float]:
    """Greatest distance to a side and above the floor; a pose thrown far off does not count."""
    seen = points[..., :2][np.isfinite(points[..., :2]).all(axis=-1)]
    half, top = (np.abs(seen[:, 0]).max(), seen[:, 1].max()) if len(seen) else (0.0, tall)
    return float(min(half, FARTHEST * tall)), float(np.clip(top, tall, FARTHEST * tall))


def _draw_figure(
    canvas: Canvas, figure: _Figure, spots: Array, color: Color, height: float
) -> None:
    """Bones from the farthest to the nearest; points where there are none."""
    width = max(height / 70.0, 1.5)
    depth = np.nan_to_num(spots[:, 2])
    for joint, parent in sorted(figure.bones, key=lambda bone: -depth[list(bone)].sum()):
        shade = paler(color, 0.55) if figure.is_left[joint] else color
        canvas.line(spots[[parent, joint], :2], shade, width)
    if not figure.bones:
        for spot in spots[np.isfinite(spots).all(axis=1)]:
            canvas.dot(spot[:2], color, width)
    if figure.head is not None:
        canvas.dot(spots[list(figure.head), :2].mean(axis=0), color, height / 20.0)
