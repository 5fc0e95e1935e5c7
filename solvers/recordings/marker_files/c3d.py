"""Read C3D files: marker tracks of optical systems, and poses of segments."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...motion import Motion, Tracks
from ...progress import Progress, Remark, unwatched
from ..containers import C3dFile
from ..conventions import (
    Bodies,
    bodies_of_markers,
    check_scale,
    estimate_axes_of_points,
    guess_unit_of_points,
    is_upside_down,
    meters_from_unit_name,
    other_standing_axis,
    point_names,
    points_z_up,
)
from .c3d_rotations import has_rotations, read_c3d_rotations

NON_POSITION_PARAMETERS = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS")


def read_c3d(
    path: Path | str,
    *,
    scale: float | None = None,
    body: str | None = None,
    progress: Progress = unwatched,
) -> Motion | Tracks:
    """Read the points of a C3D file, in meters, Z up; missing points are NaN.

    A point is missing if its residual is negative or it is exactly at the origin, as some
    programs write it. Joint angles, forces and other results of models that are stored as
    points are dropped. Up is the Y axis of the screen (POINT:Y_SCREEN); without it, up is
    estimated to be Y or Z (`points_z_up`). The heading of the actor is unchanged. Analog
    signals and events are not read. Of a file without points, the poses of segments in its
    ROTATION group are read (`read_c3d_rotations`).

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: POINT:UNITS or, without it, the unit of meters, centimeters and millimeters that
        gives a person's size.
    body : str, optional
        Name or number of a subject (`Bodies.choose`); by default the person in most frames, or
        all markers of one person and its props.
    progress : Progress

    Returns
    -------
    Tracks, or Motion of the segments of a body
        Names are unique (`LFHD_2`), and without the prefix of the actor (`Anna:LFHD`) if there
        is only one, or one is read; unnamed points are called `point_<number>`.

    Raises
    ------
    InvalidFileError
        The file is missing, truncated, not C3D, or has no points.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    bodies = open_c3d(path, scale=scale, progress=progress)
    return bodies.read_one(body, progress)


def open_c3d(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[Motion | Tracks]:
    """List the subjects of a file that `read_c3d` reads."""
    check_scale(scale)
    file = C3dFile(path)
    progress(0.1, "Reading")
    if has_rotations(file):
        if not file.n_points:
            recording = read_c3d_rotations(file, scale, progress)
            return Bodies(str(path), (), lambda index, progress: recording)
        progress(0.1, Remark("The poses of segments in its ROTATION group are left out"))
    points, observed = file.read_points()
    progress(0.6, "Reading")
    points[~observed | (points == 0.0).all(axis=-1) | ~np.isfinite(points).all(axis=-1)] = (
        np.nan
    )
    labels = _labels(file, points.shape[1])
    non_positions = {
        label for kind in NON_POSITION_PARAMETERS for label in file.texts(f"POINT:{kind}")
    }
    columns = [
        index for index, label in enumerate(labels) if label not in non_positions or not label
    ]
    points = points[:, columns]
    if not points.size or np.isnan(points).all():
        raise InvalidFileError(f"{path} has no points that are observed in any frame.")
    used = [labels[index] for index in columns]
    unit = _unit(file, points, used, progress) if scale is None else scale
    points *= unit
    up = _up(file, points, used, progress)
    axes = estimate_axes_of_points(points, up, unit, labels=used)
    positions = points_z_up(points, axes.up)
    tracks = Tracks(point_names(used), positions, file.frame_rate, conventions=axes)
    progress(1.0, "Reading")
    return bodies_of_markers(path, tracks, used)


def _up(
    file: C3dFile, points: NDArray[np.float64], labels: list[str], progress: Progress
) -> str:
    """Return the Y axis of the screen, unless points, in meters, show that it is not up."""
    screen = file.texts("POINT:Y_SCREEN")
    up = screen[0].strip().upper() if screen else ""
    if is_upside_down(points, up):
        progress(
            0.8,
            Remark(
                f"Y_SCREEN states {up}, which would put the actor below the floor; it"
                " was ignored"
            ),
        )
        return f"+{up[-1]}"
    if other := other_standing_axis(points, up, labels):
        progress(
            0.8,
            Remark(f"Y_SCREEN states {up}, but the actor stands along {other}, which is used"),
        )
        return other
    return up


def _labels(file: C3dFile, n_points: int) -> list[str]:
    """Return one label per point; empty if the file has too few."""
    labels = file.texts("POINT:LABELS")
    number = 2
    while more_labels := file.texts(f"POINT:LABELS{number}"):  # One parameter holds only 255.
        labels = labels + more_labels
        number += 1
    return (labels + [""] * n_points)[:n_points]


def _unit(
    file: C3dFile, points: NDArray[np.float64], labels: list[str], progress: Progress
) -> float:
    """Return meters per unit of the file."""
    stated_unit = meters_from_unit_name("".join(file.texts("POINT:UNITS")[:1]))
    if stated_unit is not None:
        return stated_unit
    return guess_unit_of_points(points, labels, progress)
