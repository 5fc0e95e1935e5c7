"""Joints of a depth camera, in whatever format, and out again in one of our own."""

from pathlib import Path

from ..errors import InvalidFileError
from ..motion import JointRecording
from ..progress import Progress, unwatched
from .joint_files import write_joint_csv, write_joint_json
from .read_recording import read_tracked

WRITERS = {".csv": write_joint_csv, ".json": write_joint_json}


def read_joints(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> JointRecording:
    """Read a joint recording of any format known here, told by what the file holds.

    Parameters and errors are those of `read_recording`; InvalidFileError also for a file that
    holds something else.
    """
    recording = read_tracked(path, scale=scale, progress=progress)
    if not isinstance(recording, JointRecording):
        raise InvalidFileError(
            f"{path} holds no joints of a depth camera. Read it with read_recording."
        )
    return recording


def write_joints(
    recording: JointRecording, path: Path | str, *, progress: Progress = unwatched
) -> None:
    """Write a joint recording as our own CSV or JSON, as the name's ending says.

    Raises InvalidFileError for another ending, and whatever the writer raises.
    """
    write = WRITERS.get(Path(path).suffix.lower())
    if write is None:
        raise InvalidFileError(
            f"{path}: joints are written as {' or '.join(WRITERS)}; end the name so."
        )
    write(recording, path, progress=progress)
