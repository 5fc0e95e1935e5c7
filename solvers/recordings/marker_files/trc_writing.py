"""Write TRC files that OpenSim and motion-capture programs read."""

from pathlib import Path

import numpy as np

from ...files import write_atomically
from ...motion import Tracks
from ...progress import Progress, unwatched
from ..conventions import y_up_from_z_up

MILLIMETERS_PER_METER = 1000.0
NEAR_ORIGIN_MM = 1e-6
"""Millimeters that replace an exact origin, which readers interpret as missing. By definition
the last of the six decimals that are written."""
FRAMES_AT_ONCE = 500
KEYS = (
    "DataRate", "CameraRate", "NumFrames", "NumMarkers", "Units", "OrigDataRate",
    "OrigDataStartFrame", "OrigNumFrames",
)  # fmt: skip


def write_trc(tracks: Tracks, path: Path | str, *, progress: Progress = unwatched) -> None:
    """Write tracks as a TRC file, atomically: millimeters, Y up, six decimals.

    Missing points are blank. Frames are numbered from 1, time starts at 0. Tabs and line ends
    in names become spaces. The format has no confidence.

    Parameters
    ----------
    tracks : Tracks
    path : Path or str
    progress : Progress

    Raises
    ------
    InvalidFileError
        The file cannot be written.
    SolveCancelled
        Raised by `progress`; the file is unchanged.
    """
    n_frames, n_points = tracks.n_frames, tracks.n_points
    rate = repr(tracks.frame_rate)
    values = (rate, rate, n_frames, n_points, "mm", rate, 1, n_frames)
    names = "\t\t\t".join(" ".join(name.split()) for name in tracks.names)
    axes = "\t".join(f"X{number}\tY{number}\tZ{number}" for number in range(1, n_points + 1))
    positions = MILLIMETERS_PER_METER * y_up_from_z_up(tracks.positions)
    positions = np.round(positions, 6) + 0.0  # No "-0.000000".
    positions[(positions == 0.0).all(axis=-1), 0] = NEAR_ORIGIN_MM
    positions[~tracks.visible] = np.nan
    rows = positions.reshape(n_frames, -1)
    with write_atomically(path) as part, part.open("w", encoding="utf-8", newline="\n") as file:
        file.write(f"PathFileType\t4\t(X/Y/Z)\t{Path(path).name}\tY up\n")
        file.write("\t".join(KEYS) + "\n" + "\t".join(map(str, values)) + "\n")
        file.write(f"Frame#\tTime\t{names}\t\t\n\t\t{axes}\n\n")
        for start in range(0, n_frames, FRAMES_AT_ONCE):
            for frame, row in enumerate(rows[start : start + FRAMES_AT_ONCE].tolist(), start):
                cells = "\t".join("" if cell != cell else f"{cell:.6f}" for cell in row)
                file.write(f"{frame + 1}\t{frame / tracks.frame_rate:.7f}\t{cells}\n")
            progress(min(1.0, (start + FRAMES_AT_ONCE) / n_frames), "Writing")
