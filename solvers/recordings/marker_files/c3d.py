"""Read C3D files: marker tracks of optical systems."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...motion import Tracks
from ...progress import Progress, unwatched
from ..containers import C3dFile
from ..conventions import (
    check_scale,
    guess_unit_of_points,
    meters_from_unit_name,
    point_names,
    points_z_up,
)

NON_POSITION_PARAMETERS = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS")


def read_c3d(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Tracks:
    """Read the points of a C3D file, in metres, Z up; what was not seen is NaN.

    A point is not seen where its residual is negative or it lies exactly at the origin, by
    which some programs mean the same. Joint angles, forces and the like, which models store as
    if they were points, are left out. Up is the screen's Y axis (POINT:Y_SCREEN); where the
    file does not say it, up is guessed to be Y or Z (`points_z_up`). Which way the actor faces
    is not changed. Analog signals and events are not read.

    Parameters
    ----------
    path : Path or str
    scale : float, metres per unit of the file, or None
        None takes the file's word (POINT:UNITS) or, where it has none, the one of metres,
        centimetres and millimetres that gives a person's size.
    progress : Progress

    Returns
    -------
    Tracks
        Names without the actor's (`Anna:LFHD`) if there is only one, and different from each
        other (`LFHD_2`); unnamed points are called `point_<number>`.

    Raises
    ------
    InvalidFileError
        The file is missing, cut short, no C3D file, or has no points.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    file = C3dFile(path)
    progress(0.1, "Reading")
    points, seen = file.read_points()
    progress(0.6, "Reading")
    points[~seen | (points == 0.0).all(axis=-1) | ~np.isfinite(points).all(axis=-1)] = np.nan
    labels = _labels(file, points.shape[1])
    other = {label for kind in NON_POSITION_PARAMETERS for label in file.texts(f"POINT:{kind}")}
    places = [index for index, label in enumerate(labels) if label not in other or not label]
    points = points[:, places]
    if not points.size or np.isnan(points).all():
        raise InvalidFileError(f"{path} has no points that are seen in any frame.")
    names = point_names([labels[index] for index in places])
    points *= _unit(file, points) if scale is None else scale
    screen = file.texts("POINT:Y_SCREEN")
    up = screen[0].strip().upper() if screen else ""
    tracks = Tracks(names, points_z_up(points, up), file.frame_rate)
    progress(1.0, "Reading")
    return tracks


def _labels(file: C3dFile, n_points: int) -> list[str]:
    """Return one label per point; empty where the file has too few."""
    labels = file.texts("POINT:LABELS")
    number = 2
    while further := file.texts(f"POINT:LABELS{number}"):  # One parameter holds only 255.
        labels = labels + further
        number += 1
    return (labels + [""] * n_points)[:n_points]


def _unit(file: C3dFile, points: NDArray[np.float64]) -> float:
    """Return metres per unit of the file."""
    said = meters_from_unit_name("".join(file.texts("POINT:UNITS")[:1]))
    return guess_unit_of_points(points) if said is None else said
