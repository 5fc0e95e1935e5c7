"""Read joints of a depth camera in any format, and write them in our own formats."""

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
    """Read a joint recording of any supported format, detected from the file content.

    Parameters and errors are those of `read_recording`; a file with other
    content also raises InvalidFileError.
    """
    recording = read_tracked(path, scale=scale, progress=progress)
    if not isinstance(recording, JointRecording):
        raise InvalidFileError(
            f"{path} has no joints of a depth camera. Read it with read_recording."
        )
    return recording


def write_joints(
    recording: JointRecording, path: Path | str, *, progress: Progress = unwatched
) -> None:
    """Write a joint recording as our own CSV or JSON, by the suffix of the name.

    Raises InvalidFileError for another suffix, and the errors of the writer.
    """
    write = WRITERS.get(Path(path).suffix.lower())
    if write is None:
        raise InvalidFileError(
            f"{path} has no supported suffix for joints. Use {' or '.join(WRITERS)}."
        )
    write(recording, path, progress=progress)
