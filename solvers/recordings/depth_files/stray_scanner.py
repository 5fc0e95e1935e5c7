"""Read folders of Stray Scanner: depth, confidence and odometry of an iPhone's LiDAR."""

from pathlib import Path

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ..containers import read_bytes
from ..conventions import MILLIMETER
from .layouts import Focal, Layout, list_images
from .settings import CameraOrientation

DEFAULT_FRAME_RATE = 60.0
WIDTHS = ((1920, 1440), (1280, 960), (640, 480), (256, 192))
"""Possible sizes of the video that the camera matrix refers to; the size is not stored."""
WITH_TIMES, POSE = 9, 7
"""Values in a line of the odometry: time, frame and pose, or the pose alone."""
MAX_STATIC_MOTION_M = 0.1
"""Movement of the camera, meters, above which it is reported. It decides a sentence only, which
rounds it to 0.1 m."""


def stray_layout(root: Path) -> Layout | None:
    """Return the layout of Stray Scanner: `camera_matrix.csv`, `depth/`, `confidence/`."""
    depth = list_images(root, "depth")
    if not depth or not (root / "camera_matrix.csv").is_file():
        return None
    focal, size = _focal(root / "camera_matrix.csv")
    confidence_files = {Path(name).stem: name for name in list_images(root, "confidence")}
    has_confidence = all(Path(name).stem in confidence_files for name in depth)
    odometry = _read_odometry(root / "odometry.csv")
    held, remarks = _camera_orientation(odometry)
    times = _times(odometry, depth)
    return Layout(
        root,
        depth,
        times,
        rate=DEFAULT_FRAME_RATE,
        meters=MILLIMETER,
        focal=focal,
        focal_size=size,
        confidence=tuple(confidence_files[Path(name).stem] for name in depth)
        if has_confidence
        else None,
        held=held,
        remarks=remarks,
    )


def _focal(path: Path) -> tuple[Focal, tuple[int, int]]:
    matrix = _numbers(path)
    if matrix.shape != (3, 3):
        raise InvalidFileError(f"{path} holds no 3 x 3 camera matrix. Export the scan again.")
    fx, fy, cx, cy = matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2]
    size = min(WIDTHS, key=lambda size: abs(np.log(max(cx, 1.0) * 2.0 / size[0])))
    return (float(fx), float(fy), float(cx), float(cy)), size


def _read_odometry(path: Path) -> Array:
    """Return time, frame and pose of the camera for each frame, shape (n, 9); n may be 0."""
    rows = _numbers(path) if path.is_file() else np.empty((0, WITH_TIMES))
    if rows.shape[1] == POSE:
        unknown_times = np.full((len(rows), 1), np.nan)
        rows = np.concatenate(
            [unknown_times, np.arange(len(rows))[:, np.newaxis], rows], axis=1
        )
    return rows if rows.shape[1] == WITH_TIMES else np.empty((0, WITH_TIMES))


def _numbers(path: Path) -> Array:
    """Return the rows of numbers of a table; a first row of names is skipped."""
    lines = read_bytes(path).decode("utf-8", errors="replace").splitlines()
    rows = []
    for number, line in enumerate(lines, start=1):
        words = [word for word in line.replace(",", " ").split() if word]
        try:
            rows.append([float(word) for word in words])
        except ValueError:
            if number > 1:
                raise InvalidFileError(f"{path}, line {number}: not a number.") from None
    rows = [row for row in rows if row]
    if not rows or len({len(row) for row in rows}) > 1:
        raise InvalidFileError(f"{path} is not a table of numbers. Export the scan again.")
    return np.array(rows)


def _camera_orientation(odometry: Array) -> tuple[CameraOrientation, tuple[str, ...]]:
    """Estimate the orientation of the phone from its poses, and report if it moved.

    The world of ARKit has Y up. The camera's x is to the right of the image and y down.
    """
    poses = odometry[np.isfinite(odometry[:, 2:]).all(axis=1), 2:]
    if not len(poses):
        return CameraOrientation.UPRIGHT, ()
    x, y, z, w = poses[:, 3:].T
    with np.errstate(invalid="ignore", over="ignore"):  # damaged numbers
        up = np.median([2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z)], axis=1)
        distance = float(np.linalg.norm(np.ptp(poses[:, :3], axis=0)))
    remarks = (
        (f"The camera moved by {distance:.1f} m; it is assumed to be static.",)
        if distance > MAX_STATIC_MOTION_M
        else ()
    )
    if abs(up[0]) > abs(up[1]):
        return (CameraOrientation.RIGHT if up[0] > 0.0 else CameraOrientation.LEFT), remarks
    return (
        CameraOrientation.UPSIDE_DOWN if up[1] > 0.0 else CameraOrientation.UPRIGHT
    ), remarks


def _times(odometry: Array, depth: tuple[str, ...]) -> Array | None:
    """Return the time of each image; None if one is unknown."""
    time_by_frame = dict(zip(odometry[:, 1].tolist(), odometry[:, 0].tolist(), strict=True))
    numbers = [int(stem) if (stem := Path(name).stem).isdecimal() else -1 for name in depth]
    times = np.array([time_by_frame.get(number, np.nan) for number in numbers])
    return times if np.isfinite(times).all() else None
