"""Read UI-PRMD takes: a Kinect v2 and an optical system that recorded the same exercise."""

from pathlib import Path

import numpy as np

from ...errors import InvalidFileError
from ...motion import FileConventions, JointRecording, Sensor, Tracks
from ...motion.skeletons import UI_PRMD
from ...progress import Progress, unwatched, within
from ..containers import read_archive
from ..conventions import JointSamples, check_scale, joint_recording, with_conventions

NAMES = tuple(UI_PRMD)
MARKERS = (
    "LFHD", "RFHD", "LBHD", "RBHD", "C7", "T10", "CLAV", "STRN", "RBAK", "LSHO", "LUPA", "LELB",
    "LFRM", "LWRA", "LWRB", "LFIN", "RSHO", "RUPA", "RELB", "RFRM", "RWRA", "RWRB", "RFIN",
    "LASI", "RASI", "LPSI", "RPSI", "LTHI", "LKNE", "LTIB", "LANK", "LHEE", "LTOE", "RTHI",
    "RKNE", "RTIB", "RANK", "RHEE", "RTOE",
)  # fmt: skip
KEYS = ("kinect", "markers", "unit_m", "frame_rate")


def is_ui_prmd(head: bytes) -> bool:
    """Return whether the first bytes are an archive that begins with the joint array."""
    return head[:4] == b"PK\x03\x04" and head[30:40] == b"kinect.npy"


def read_ui_prmd(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> JointRecording:
    """Read the Kinect joints of a UI-PRMD take [1]_: `read_ui_prmd_pair` without markers."""
    return read_ui_prmd_pair(path, scale=scale, progress=progress)[0]


def read_ui_prmd_pair(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> tuple[JointRecording, Tracks]:
    """Read a UI-PRMD take [1]_ stored as `.npz`: Kinect joints and optical markers, in meters.

    Both are in the same world space, Z up, and have the same times, as they were aligned for
    the archive (keys kinect, markers, unit_m, frame_rate); height 0 is the floor. The heading
    of the actor is unchanged. Positions exactly at the origin are missing and become NaN. The
    data set has no tracking state.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: unit_m of the file.
    progress : Progress

    Returns
    -------
    JointRecording, Tracks
        22 joints and 39 markers, of equal length and frame rate.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or has other arrays.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Vakanski, Jun, Paul, Baker (2018). A data set of human body movements for physical
       rehabilitation exercises. Data 3(1). doi:10.3390/data3010002
    """
    check_scale(scale)
    kinect, markers, unit, frame_rate = read_archive(path, KEYS)
    n_frames = len(kinect) if kinect.ndim else 0
    shapes = ((n_frames, len(NAMES), 3), (n_frames, len(MARKERS), 3), (), ())
    stored_shapes = tuple(array.shape for array in (kinect, markers, unit, frame_rate))
    if stored_shapes != shapes or not (0.0 < unit < np.inf and 0.0 < frame_rate < np.inf):
        raise InvalidFileError(
            f"{path} holds arrays of shapes {', '.join(map(str, stored_shapes))}; a UI-PRMD"
            f" take has {len(NAMES)} joints and {len(MARKERS)} markers in as many frames, a"
            " unit and a frame rate."
        )
    meters = float(unit) if scale is None else scale
    recording = joint_recording(
        path,
        JointSamples(NAMES, kinect, Sensor.KINECT_V2, frame_rate=float(frame_rate)),
        scale=meters,
        conventions=FileConventions(),
        progress=within(progress, 0.0, 0.9),
    )
    recording = with_conventions(recording, FileConventions(unit=meters))
    missing = (markers == 0.0).all(axis=-1) | ~np.isfinite(markers).all(axis=-1)
    positions = np.where(missing[..., None], np.nan, markers * meters)
    tracks = Tracks(MARKERS, positions, float(frame_rate))
    progress(1.0, "Reading")
    return recording, tracks
