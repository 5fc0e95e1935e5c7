"""Solve of the button Track Live: track a depth recording while a recorder writes it."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import NamedTuple

import numpy as np

from ...solvers.arrays import Single
from ...solvers.denoising import PlantSettings
from ...solvers.depth_scene import Camera, DepthImage, FloorPlane, ForegroundSettings
from ...solvers.depth_tracking.capturing import CaptureSettings
from ...solvers.errors import InvalidMotionError, SolveCancelled
from ...solvers.progress import Progress, unwatched
from ...solvers.recordings.depth_files import DepthSettings
from ...solvers.recordings.growing import open_growing
from ...solvers.workflows.following import (
    DetectorProcess,
    FollowSettings,
    FollowState,
    follow_depth,
)
from .pose_previews import FloorPreview, PosePreviewSender, Show, no_preview
from .solve_tracking import Tracked, build_tracked

MAX_SHOWN_POINTS = 3000
"""Number of points of an image that are shown. It bounds the size of the previews."""
SHOWN_INTERVAL_S = 0.1
"""Seconds between two images that are shown. It bounds the size of the previews."""


@dataclass(frozen=True, eq=False)
class FollowProblem:
    """All that Track Live depends on."""

    path: Path
    depth: DepthSettings
    following: FollowSettings
    tracking: CaptureSettings
    actor: ForegroundSettings
    planting: PlantSettings | None
    first_frame: float
    """Frame of the scene at which the motion begins."""


class PointsPreview(NamedTuple):
    """An image as points in the camera's frame, meters, shape (n_points, 3)."""

    points: Single


class Followed(NamedTuple):
    """What becomes of a recording that was followed."""

    tracked: Tracked
    camera: Camera
    """Of its images, which may be gone."""
    first_frame: float
    path: Path
    """Of the recording; a path relative to the file would change when the file is saved."""


def follow_recording(
    problem: FollowProblem,
    *,
    show: Show = no_preview,
    is_ended: Callable[[], bool] = lambda: False,
    progress: Progress = unwatched,
) -> Followed:
    """Follow a recording until nothing more comes, or it `is_ended`.

    Raises
    ------
    InvalidFileError
        The images are no depth, or the camera or scale is unknown.
    InvalidMotionError
        No image came, or no person was detected.
    SolveCancelled
        It was ended before there was a motion.
    """
    growing = open_growing(problem.path, problem.depth)
    display = _Display(show, progress)
    try:
        with DetectorProcess() as detector:
            found = follow_depth(
                growing,
                detector,
                settings=problem.following,
                capture=problem.tracking,
                foreground=problem.actor,
                planting=problem.planting,
                on_pose=PosePreviewSender(show),
                on_state=display.add,
                is_ended=is_ended,
                progress=display.progress,
            )
    except InvalidMotionError as error:
        if is_ended():
            raise SolveCancelled(str(error)) from None
        raise
    assert growing.camera is not None
    floor = display.floor
    tracked = build_tracked(found.first, found.motion, found.captured, floor, found.remarks)
    return Followed(tracked, growing.camera, problem.first_frame, problem.path)


class _Display:
    """Sends floor, points and progress to the window."""

    def __init__(self, show: Show, progress: Progress) -> None:
        self._show, self._progress = show, progress
        self._has_begun, self._is_measured, self._shown_at = False, False, -np.inf
        self.floor: FloorPlane | None = None

    def add(self, state: FollowState) -> None:
        """Show what is known after an image."""
        self._has_begun = True
        if state.actor is not None and not self._is_measured:
            self._is_measured, self.floor = True, state.actor.floor
            self._show(FloorPreview(self.floor))
        now = monotonic()
        if state.depth is not None and now - self._shown_at >= SHOWN_INTERVAL_S:
            self._shown_at = now
            self._show(PointsPreview(points_of(state.camera, state.depth)))

    def progress(self, fraction: float, message: str = "") -> None:
        """Report how far the measurement is; how long the rest takes is unknown."""
        is_measuring = self._has_begun and not self._is_measured
        self._progress(fraction if is_measuring else 1.0, message)


def points_of(camera: Camera, depth: DepthImage) -> Single:
    """Return up to `MAX_SHOWN_POINTS` points of an image, shape (n_points, 3), meters."""
    row, column = np.nonzero(depth)
    if len(row) > MAX_SHOWN_POINTS:
        kept = np.linspace(0, len(row) - 1, MAX_SHOWN_POINTS).astype(int)
        row, column = row[kept], column[kept]
    rays = camera.rays()[row, column]
    return (rays * depth[row, column, np.newaxis]).astype(np.float32)
