"""Read C3D files: marker tracks of optical systems."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidFileError
from ..motion import Tracks
from ..progress import Progress, unwatched
from .axes import check_scale, z_up_from_y_up
from .c3d_file import C3dFile
from .names import DifferentNames, printable

METRES = {
    "mm": 0.001, "millimeters": 0.001, "millimetres": 0.001, "cm": 0.01, "centimeters": 0.01,
    "centimetres": 0.01, "dm": 0.1, "m": 1.0, "meters": 1.0, "metres": 1.0, "in": 0.0254,
    "inch": 0.0254, "inches": 0.0254, "ft": 0.3048, "feet": 0.3048,
}  # fmt: skip
BODY_EXTENT = 1.5
FLOOR_TOLERANCE = 0.15
NOT_PLACES = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS")


def read_c3d(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Tracks:
    """Read the points of a C3D file, in metres, Z up; what was not seen is NaN.

    A point is not seen where its residual is negative or it lies exactly at the origin, by
    which some programs mean the same. Joint angles, forces and the like, which models store as
    if they were points, are left out. Up is the screen's Y axis (POINT:Y_SCREEN); where the
    file does not say it, up is guessed to be Y or Z (`_looks_y_up`). Which way the actor faces
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
    other = {label for kind in NOT_PLACES for label in file.texts(f"POINT:{kind}")}
    places = [index for index, label in enumerate(labels) if label not in other or not label]
    points = points[:, places]
    if not points.size or np.isnan(points).all():
        raise InvalidFileError(f"{path} has no points that are seen in any frame.")
    names = _names([labels[index] for index in places])
    points *= _unit(file, points) if scale is None else scale
    screen = file.texts("POINT:Y_SCREEN")
    up = screen[0].strip().upper() if screen else ""
    tracks = Tracks(names, _z_up(points, up), file.frame_rate)
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


def _names(labels: list[str]) -> tuple[str, ...]:
    prefixes = {label.rpartition(":")[0] for label in labels if ":" in label}
    if len(prefixes) == 1:
        labels = [label.rpartition(":")[2] for label in labels]
    names = DifferentNames()
    return tuple(
        names.give(printable(label) or f"point_{place}")
        for place, label in enumerate(labels, start=1)
    )


def _unit(file: C3dFile, points: NDArray[np.float64]) -> float:
    """Return metres per unit of the file."""
    said = "".join(file.texts("POINT:UNITS")[:1]).strip().lower()
    if said in METRES:
        return METRES[said]
    extent = float(np.median(_extents(points).max(axis=1)))
    if extent == 0.0:
        return METRES["mm"]
    return min((0.001, 0.01, 1.0), key=lambda unit: abs(np.log(extent * unit / BODY_EXTENT)))


def _z_up(points: NDArray[np.float64], up: str) -> NDArray[np.float64]:
    """Turn points, in metres, so that `up`, such as `+Y` or unknown, becomes Z."""
    if up[-1:] not in {"X", "Y", "Z"}:
        up = "+Y" if _looks_y_up(points) else "+Z"
    if up[-1] == "X":
        points = np.roll(points, -1, axis=-1)  # x y z -> y z x
    if up[-1] == "Y":
        points = z_up_from_y_up(points)
    return points * (1.0, -1.0, -1.0) if up[0] == "-" else points


def _looks_y_up(points: NDArray[np.float64]) -> bool:
    """Whether Y rather than Z is up, of points in metres.

    Nobody is far below the floor: if that rules out one of the two, the other is up. Else the
    greater extent in most frames decides; right for all files at hand that say their axes.
    """
    above = np.nanpercentile(points.reshape(-1, 3), 2, axis=0) > -FLOOR_TOLERANCE
    if above[1] != above[2]:
        return bool(above[1])
    _, y, z = np.median(_extents(points), axis=0)
    return bool(y > z)


def _extents(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the size of the bounding box, shape (n, 3), in frames where anything is seen."""
    seen = points[np.isfinite(points).any(axis=(1, 2))]
    return np.asarray(np.nanmax(seen, axis=1) - np.nanmin(seen, axis=1))
