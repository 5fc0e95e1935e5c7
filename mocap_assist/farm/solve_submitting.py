"""List the takes of a folder for the workers of a farm, and submit the job that fixes them."""

import json
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

from ...solvers.command_line.farm import (
    FlamencoJob,
    FlamencoSettings,
    SubmittedJob,
    submit_job,
    texts_of_settings,
)
from ...solvers.command_line.files import MOTIONS, find_recordings, unique_targets
from ...solvers.command_line.fix_verb import add_fix_options, list_takes
from ...solvers.errors import InvalidFileError
from ...solvers.files import reason_of, write_atomically
from ...solvers.progress import Progress, within
from ...solvers.workflows import FixSettings

N_DIGITS = 8
"""Hexadecimal digits of a hash in the name of a list. It guards the list of a job that runs:
other takes have another name, the same takes the same."""


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


def submit_takes(problem: Submission, progress: Progress) -> Submitted:
    """Write the list of takes into the output folder and submit the job.

    Raises
    ------
    InvalidFileError
        The folder has no takes, or the list cannot be written.
    MocapAssistError
        The Flamenco Manager does not accept the job.
    """
    found = find_recordings([problem.takes], problem.output_folder, list_takes)
    progress(0.3, "Listing")
    targets = unique_targets([name for _, name in found], [MOTIONS] * len(found))
    lines = [
        json.dumps({"input": str(path), "output": target.as_posix()}) + "\n"
        for (path, _), target in zip(found, targets, strict=True)
    ]
    job = FlamencoJob(
        verb="fix",
        title=problem.takes.name,
        manifest=_write_list(problem, "".join(lines)),
        output_folder=problem.output_folder,
        texts=texts_of_settings(add_fix_options, problem.fixing),
        command=problem.command,
        settings=problem.settings,
    )
    submitted = submit_job(job, problem.address, progress=within(progress, 0.5, 1.0))
    return Submitted(submitted, len(found))


def _write_list(problem: Submission, text: str) -> Path:
    """Write the list of takes, unless it is there; return its file."""
    digest = sha256(text.encode()).hexdigest()[:N_DIGITS]
    path = problem.output_folder / f"{problem.takes.name}.takes-{digest}.txt"
    try:
        problem.output_folder.mkdir(exist_ok=True)
    except OSError as error:
        raise InvalidFileError(
            f"The folder {problem.output_folder} cannot be made: {reason_of(error)}."
        ) from None
    with write_atomically(path) as part:
        part.write_text(text, encoding="utf-8")
    return path
