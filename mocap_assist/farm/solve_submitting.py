"""List the takes of a folder for the workers of a farm, and submit the job that fixes them."""

import json
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

from ...solvers.command_line.arguments import (
    MOTIONS,
    find_recordings,
    scene_files_in,
    unique_targets,
)
from ...solvers.command_line.farm import (
    FlamencoJob,
    FlamencoSettings,
    SubmittedJob,
    check_job,
    texts_of_settings,
)
from ...solvers.command_line.fix_verb import add_fix_options
from ...solvers.errors import InvalidFileError
from ...solvers.files import reason_of, write_atomically
from ...solvers.progress import Progress
from ...solvers.recordings import takes_in
from ...solvers.workflows import FixSettings
from ..track.pose_previews import Show, no_preview

N_DIGITS = 8
"""Hexadecimal digits of a hash in the name of a list. It guards the list of a job that runs:
other takes have another name, the same takes the same."""
SUBMITTING = "Submitting"
"""Progress while the job is sent: the Manager may have it already."""


class Submission(NamedTuple):
    """A folder of takes, and what the farm does with it."""

    takes: Path
    output_folder: Path
    address: str
    """Of the Flamenco Manager."""
    command: str
    settings: FlamencoSettings
    fixing: FixSettings


class Submitted(NamedTuple):
    """A submitted folder."""

    job: SubmittedJob
    n_takes: int
    n_left_out: int
    """Files that only Blender reads, such as FBX."""


def submit_takes(problem: Submission, progress: Progress, show: Show = no_preview) -> Submitted:
    """Write the list of takes into the output folder and submit the job.

    Nothing is written before the Manager has the job type.

    Parameters
    ----------
    problem : Submission
    progress : Progress
    show : Show
        Called with `SUBMITTING` before the job is sent. Unlike progress, no call is skipped.

    Raises
    ------
    InvalidFileError
        The folder has no takes, or the list cannot be written.
    MocapAssistError
        The Flamenco Manager does not accept the job.
    """
    progress(0.0, "Listing")
    found = find_recordings([problem.takes], problem.output_folder, takes_in)
    n_left_out = len(scene_files_in(problem.takes, problem.output_folder))
    targets = unique_targets([name for _, name in found], [MOTIONS] * len(found))
    lines = [
        json.dumps({"input": str(path), "output": target.as_posix()}) + "\n"
        for (path, _), target in zip(found, targets, strict=True)
    ]
    text = "".join(lines)
    job = FlamencoJob(
        verb="fix",
        title=problem.takes.name,
        manifest=_path_of_list(problem, text),
        output_folder=problem.output_folder,
        texts=texts_of_settings(add_fix_options, problem.fixing),
        command=problem.command,
        settings=problem.settings,
    )
    progress(0.3, "Connecting")
    checked = check_job(job, problem.address)
    _write_list(job.manifest, text)
    progress(0.7, SUBMITTING)
    show(SUBMITTING)
    return Submitted(checked.submit(), len(found), n_left_out)


def _path_of_list(problem: Submission, text: str) -> Path:
    """Return the file for a list of takes."""
    digest = sha256(text.encode()).hexdigest()[:N_DIGITS]
    return problem.output_folder / f"{problem.takes.name}.takes-{digest}.txt"


def _write_list(path: Path, text: str) -> None:
    """Write a list of takes."""
    output_folder = path.parent
    try:
        output_folder.mkdir(exist_ok=True)
    except OSError as error:
        raise InvalidFileError(
            f"The folder {output_folder} cannot be made: {reason_of(error)}."
        ) from None
    with write_atomically(path) as part:
        part.write_text(text, encoding="utf-8")
