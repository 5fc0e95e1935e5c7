"""Draw strips of stick figures: several recordings over each other, at several times."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import InvalidMotionError
from ..motion import (
    JointRecording,
    Motion,
    Tracks,
    find_humanoid_map,
    forward_kinematics,
)
from ..motion.humanoid import SIDES
from ..rotations import rotate
from ..settings import Choice, Settings, setting
from .body_parts import head_bone, left_joints
from .canvas import FAINT, INK, Canvas, Color, lighten_color, series_colors
from .picture import Picture

Recording = Motion | Tracks | JointRecording

TOP, BOTTOM, MARGIN = 44.0, 34.0, 16.0
MIN_WIDTH = 0.35
"""Minimum width of the cell of one figure, as a fraction of its height."""
MAX_EXTENT = 1.3
"""Maximum extent of a figure to either side and upwards, in statures."""
AVERAGING_S = 0.5
"""Seconds over which the heading of the figure is averaged."""


class ViewDirection(Choice):
    """Direction of the view, which rotates with the body."""

    SIDE = "side", "See the body from its side"
    FRONT = "front", "See the body from the front"
    QUARTER = "quarter", "See the body from between side and front"


AZIMUTH = {
    ViewDirection.SIDE: 0.0,
    ViewDirection.FRONT: np.pi / 2,
    ViewDirection.QUARTER: np.pi / 4,
}


@dataclass(frozen=True, kw_only=True)
class StickFigureSettings(Settings):
    """Parameters of stick figures."""

    n_figures: int = setting(
        8, "Number of figures, evenly spaced in time", minimum=1, maximum=200
    )
    view: ViewDirection = setting(ViewDirection.SIDE, "Direction of the view")
    height: int = setting(
        260, "Height of a figure; higher shows more detail", unit="px", minimum=40, maximum=2000
    )


class _Figure(NamedTuple):
    """Drawing data of a recording."""

    points: Array
    """Shape (n_figures, n_points, 3), meters."""
    bones: tuple[tuple[int, int], ...]
    """Joint and parent; empty for points without a skeleton."""
    is_left: NDArray[np.bool_]
    stature: float
    head: tuple[int, int] | None
    """Both ends of the head."""


def draw_stick_figures(
    recordings: Mapping[str, Recording],
    settings: StickFigureSettings = StickFigureSettings(),
    *,
    frames: range | None = None,
) -> Picture:
    """Draw recordings over each other, the last one on top, at evenly spaced times.

    Each time has its own cell from left to right, with the floor (z = 0) as a line. The limbs
    of the left side (+X in the rest pose) are lighter; points without a skeleton are dots. A
    missing joint and its descendants are not drawn. The view moves and rotates with the last
    recording, which fits into the cells; figures of the others may exceed them.

    Parameters
    ----------
    recordings : mapping from label to Motion, Tracks or JointRecording
        All with the same number of frames; labels and colors go into the legend.
    settings : StickFigureSettings
    frames : range, optional
        The interval to draw from; all by default.

    Returns
    -------
    Picture

    Raises
    ------
    InvalidMotionError
        There is nothing to draw, or the recordings do not have the same number of frames.
    """
    frame_indices = _shown_frames(recordings, settings.n_figures, frames)
    last = list(recordings.values())[-1]
    center, heading = _camera_target(last, frame_indices)
    figures = [_figure(recording, frame_indices) for recording in recordings.values()]
    screen_points = [
        project_to_view(each.points - center, heading, settings.view) for each in figures
    ]
    stature = max(figure.stature for figure in figures)
    scale = settings.height / stature
    half, top = _extent(screen_points[-1], stature)
    cell_width = max(2.0 * half * scale, MIN_WIDTH * settings.height) + MARGIN
    floor = TOP + MARGIN + top * scale
    canvas = Canvas(
        max(cell_width * len(frame_indices), 360.0) + 2 * MARGIN, floor + BOTTOM + MARGIN
    )
    canvas.legend(MARGIN, TOP / 2.0, list(recordings))
    canvas.line(
        [(MARGIN, floor), (MARGIN + cell_width * len(frame_indices), floor)], FAINT, 1.0
    )
    for index, frame in enumerate(frame_indices):
        middle = MARGIN + (index + 0.5) * cell_width
        canvas.text(middle, floor + 18.0, f"{frame / last.frame_rate:.2f} s", INK, "mm")
        colors = series_colors(len(recordings))
        for figure, visible_points, color in zip(figures, screen_points, colors, strict=True):
            screen_figure = visible_points[index] * (scale, -scale, 1.0) + (middle, floor, 0.0)
            _draw_figure(canvas, figure, screen_figure, color, settings.height)
    return canvas.picture()


def project_to_view(positions: Array, heading: Array, view: ViewDirection) -> Array:
    """Return coordinates in the view: to the right, up, and away, in meters.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3), meters
    heading : shape (n_frames,), radians
        Heading of the body about Z; 0 is -Y. In the side view it faces right; in the front view
        its left side (+X at heading 0) is on the right.
    view : ViewDirection
    """
    forward = np.stack([np.sin(heading), -np.cos(heading), 0.0 * heading], axis=-1)
    left = np.stack([np.cos(heading), np.sin(heading), 0.0 * heading], axis=-1)
    azimuth = AZIMUTH[view]
    right = np.cos(azimuth) * forward + np.sin(azimuth) * left
    depth_axis = np.cos(azimuth) * left - np.sin(azimuth) * forward
    across = np.einsum("fjk,fk->fj", positions, right)
    depth = np.einsum("fjk,fk->fj", positions, depth_axis)
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


def _figure(recording: Recording, frame_indices: NDArray[np.intp]) -> _Figure:
    if isinstance(recording, JointRecording):
        is_left = np.array(["left" in name.lower() for name in recording.names])
        bones = _bones(recording.parents)
        figure = _figure(recording.tracks, frame_indices)
        return figure._replace(bones=bones, is_left=is_left)
    if isinstance(recording, Tracks):
        points = recording.positions[frame_indices]
        sides = np.zeros(recording.n_points, dtype=np.bool_)
        return _Figure(points, (), sides, _height_of_points(recording), None)
    skeleton = recording.skeleton
    shown_poses = recording.with_poses(
        recording.rotations[frame_indices], recording.root_positions[frame_indices]
    )
    roles = find_humanoid_map(skeleton).indices(skeleton)
    above_hips = {roles.get("hips", 0), *skeleton.ancestors(roles.get("hips", 0))}
    return _Figure(
        forward_kinematics(shown_poses).positions,
        tuple(bone for bone in _bones(skeleton.parents) if bone[0] not in above_hips),
        left_joints(skeleton, roles),
        skeleton.extent,
        head_bone(skeleton, roles),
    )


def _bones(parents: Sequence[int]) -> tuple[tuple[int, int], ...]:
    return tuple((joint, parent) for joint, parent in enumerate(parents) if parent >= 0)


def _camera_target(
    recording: Recording, frame_indices: NDArray[np.intp]
) -> tuple[Array, Array]:
    """Return the body's position on the floor, shape (n, 1, 3), and its heading, shape (n,)."""
    position, facing = _position_and_facing(recording)
    half_window = round(AVERAGING_S / 2.0 * recording.frame_rate)
    center, heading = np.zeros((len(frame_indices), 1, 3)), np.zeros(len(frame_indices))
    for index, frame in enumerate(frame_indices):
        window = slice(max(frame - half_window, 0), frame + half_window + 1)
        observed = position[window][np.isfinite(position[window]).all(axis=1)]
        # In a long gap of the root, keep the last observed position.
        center[index, 0, :2] = (
            observed.mean(axis=0)[:2] if len(observed) else center[index - 1, 0, :2]
        )
        sideways, back = np.nansum(facing[window], axis=0)
        heading[index] = np.arctan2(sideways, -back)
    return center, heading


def _position_and_facing(recording: Recording) -> tuple[Array, Array]:
    """Return the body's position, shape (n_frames, 3), and facing direction, (n_frames, 2).

    Points without a skeleton face their displacement from the first frame to the last; the
    joints of a depth camera face the camera.
    """
    if isinstance(recording, JointRecording):
        position, _ = _position_and_facing(recording.tracks)
        return position, np.tile((0.0, -1.0), (len(position), 1))
    if isinstance(recording, Motion):
        roles = find_humanoid_map(recording.skeleton).indices(recording.skeleton)
        hips, poses = roles.get("hips", 0), forward_kinematics(recording)
        if {"leftUpperLeg", "rightUpperLeg"} <= roles.keys():
            left, right = (poses.positions[:, roles[f"{side}UpperLeg"]] for side in SIDES)
            lateral = left - right
            return poses.positions[:, hips], np.stack([lateral[:, 1], -lateral[:, 0]], axis=1)
        facing = rotate(poses.rotations[:, hips], [0.0, -1.0, 0.0])
        return poses.positions[:, hips], facing[:, :2]
    visible = recording.visible[..., None]
    counts = np.maximum(visible.sum(axis=1), 1)
    position = np.where(visible, recording.positions, 0.0).sum(axis=1) / counts
    position[~visible.any(axis=(1, 2))] = np.nan
    observed = position[np.isfinite(position[:, 0])]
    displacement = observed[-1] - observed[0] if len(observed) else np.zeros(3)
    return position, np.tile(displacement[:2], (len(position), 1))


def _height_of_points(tracks: Tracks) -> float:
    """Return the height range of most points, meters; 1 if all are level."""
    heights = tracks.positions[tracks.visible][:, 2]
    spread = np.quantile(heights, [0.01, 0.99]) if len(heights) else np.zeros(2)
    return float(np.ptp(spread)) or 1.0


def _extent(points: Array, stature: float) -> tuple[float, float]:
    """Return the largest distance to a side and above the floor, without outlier poses."""
    finite = points[..., :2][np.isfinite(points[..., :2]).all(axis=-1)]
    half, top = (
        (np.abs(finite[:, 0]).max(), finite[:, 1].max()) if len(finite) else (0.0, stature)
    )
    return float(min(half, MAX_EXTENT * stature)), float(
        np.clip(top, stature, MAX_EXTENT * stature)
    )


def _draw_figure(
    canvas: Canvas, figure: _Figure, screen_points: Array, color: Color, height: float
) -> None:
    """Draw bones from the farthest to the nearest; points if there are none."""
    width = max(height / 70.0, 1.5)
    depth = np.nan_to_num(screen_points[:, 2])
    for joint, parent in sorted(figure.bones, key=lambda bone: -depth[list(bone)].sum()):
        shade = lighten_color(color, 0.55) if figure.is_left[joint] else color
        canvas.line(screen_points[[parent, joint], :2], shade, width)
    if not figure.bones:
        for point in screen_points[np.isfinite(screen_points).all(axis=1)]:
            canvas.dot(point[:2], color, width)
    if figure.head is not None:
        canvas.dot(screen_points[list(figure.head), :2].mean(axis=0), color, height / 20.0)
