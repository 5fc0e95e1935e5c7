"""Read the ROTATION group of C3D files: poses of segments that Theia3D and Visual3D write."""

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import Motion, Tracks
from ...progress import Progress, unwatched
from ...rotations import quaternion_from_matrix
from ..containers import BLOCK_BYTES, C3dFile, UniqueNames, printable
from ..conventions import MILLIMETER, meters_from_unit_name
from ..skeleton_files import recording_from_segments

WORDS = 17
"""Numbers of a pose: a matrix of 4 x 4, column by column, and its residual."""
ENDING = "_4X4"
MAX_DEFORMATION = 0.05
"""Deviation, a ratio, of a rotation's columns from unit length and right angles, of damaged
data. It guards against damaged data: rounding to single precision gives 0.0000001."""
MIN_RATE_HZ, MAX_RATE_HZ = 1e-3, 1e6


def has_rotations(file: C3dFile) -> bool:
    """Return whether a file has poses of segments."""
    return _number(file, "USED") >= 1.0 and _number(file, "DATA_START") >= 1.0


def read_c3d_rotations(
    file: C3dFile, scale: float | None = None, progress: Progress = unwatched
) -> Motion | Tracks:
    """Return the motion of the segments if they are a body's, otherwise their origins.

    Poses with a negative residual are missing. Segments are called as in the file, without
    the ending `_4X4`.

    Parameters
    ----------
    file : C3dFile
    scale : float, meters per unit of the file, or None
        None: POINT:UNITS or, without it, millimeters.
    progress : Progress

    Raises
    ------
    InvalidFileError
        The poses are cut short, or none is observed.
    """
    matrices, residuals = _read_poses(file)
    matrices[residuals < 0.0] = np.nan
    rotations = matrices[..., :3, :3]
    products = np.einsum("...ji,...jk->...ik", rotations, rotations)
    with np.errstate(invalid="ignore"):
        usable = (np.abs(products - np.eye(3)) < MAX_DEFORMATION).all(axis=(-2, -1))
        usable &= np.linalg.det(np.nan_to_num(rotations)) > 0.0
    usable &= np.isfinite(matrices[..., :3, 3]).all(axis=-1)
    matrices[~usable] = np.nan
    if not usable.any():
        raise InvalidFileError(f"{file.path} has no segment that is observed in any frame.")
    stated_unit = meters_from_unit_name("".join(file.texts("POINT:UNITS")[:1])) or MILLIMETER
    given = UniqueNames()
    labels = [*file.texts("ROTATION:LABELS"), *[""] * matrices.shape[1]][: matrices.shape[1]]
    names = [
        given.give(printable(label.removesuffix(ENDING)) or f"segment_{number}")
        for number, label in enumerate(labels, start=1)
    ]
    quaternions = np.full((*usable.shape, 4), np.nan)
    quaternions[usable] = quaternion_from_matrix(rotations[usable])
    progress(0.5, "Reading")
    return recording_from_segments(
        names,
        matrices[..., :3, 3] * (stated_unit if scale is None else scale),
        quaternions,
        _frame_rate(file),
        progress,
    )


def _read_poses(file: C3dFile) -> tuple[Array, Array]:
    """Return matrices, shape (n_frames, n_segments, 4, 4), and residuals."""
    start = BLOCK_BYTES * (int(_number(file, "DATA_START")) - 1)
    n_segments = int(_number(file, "USED"))
    ratio = max(1, int(_number(file, "RATIO")))
    stated = [count * ratio for count in file.frame_counts()]
    n_fitting = (len(file.content) - start) // (4 * WORDS * n_segments) if start > 0 else 0
    n_frames = max((count for count in stated if count <= n_fitting), default=0)
    if not n_frames:
        raise InvalidFileError(
            f"{file.path} is cut short: it is too small for the {min(stated)} frames of its"
            " header. Copy or export it again."
        )
    n_words = n_frames * n_segments * WORDS
    words = np.frombuffer(file.content, file.order + "f4", n_words, start)
    with np.errstate(invalid="ignore"):
        poses = words.reshape(n_frames, n_segments, WORDS).astype(np.float64)
    matrices = poses[..., :16].reshape(n_frames, n_segments, 4, 4).swapaxes(-1, -2)
    return matrices.copy(), poses[..., 16]


def _frame_rate(file: C3dFile) -> float:
    rate = _number(file, "RATE")
    return rate if MIN_RATE_HZ < rate < MAX_RATE_HZ else file.frame_rate


def _number(file: C3dFile, name: str) -> float:
    """Return a parameter of the group; 0 if it is missing or not a number."""
    values = file.numbers(f"ROTATION:{name}")
    return float(values[0]) if len(values) and np.isfinite(values[0]) else 0.0
