"""What the button Import has read for it."""

from collections.abc import Sequence
from pathlib import Path

from ...solvers.errors import InvalidFileError, MocapAssistError, SolveCancelled
from ...solvers.motion import JointRecording, Motion, Tracks
from ...solvers.progress import Progress, unwatched
from ...solvers.recordings import read_recording


def read_files(
    paths: Sequence[Path], *, progress: Progress = unwatched
) -> list[Motion | Tracks | JointRecording | MocapAssistError]:
    """Return what each file holds, or the error that says why it cannot be read."""
    found: list[Motion | Tracks | JointRecording | MocapAssistError] = []
    for path in paths:

        def share(fraction: float, message: str = "", path: Path = path) -> None:
            progress((len(found) + fraction) / len(paths), f"Reading {path.name}")

        share(0.0)
        try:
            found.append(read_recording(path, progress=share))
        except SolveCancelled:
            raise
        except MocapAssistError as error:
            found.append(error)
        except MemoryError:
            found.append(
                InvalidFileError(
                    f"{path} needs more memory than there is. Import a part of the take."
                )
            )
    return found
