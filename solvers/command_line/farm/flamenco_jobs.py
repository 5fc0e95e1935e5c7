"""Submit batches to a Flamenco Manager, whose workers process a part of the takes per task."""

import platform
import shlex
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ...errors import MocapAssistError
from ...settings import Settings, setting
from ...version import version
from .job_types import JOB_TYPE, job_type_of, script_of

if TYPE_CHECKING:
    from .flamenco_manager import FlamencoManager

PACKAGE = __package__.removesuffix(".command_line.farm")
COMMAND = f"python3 -m {'solvers' if '.' in PACKAGE else PACKAGE}"
"""Command of Mocap Assist on workers that have what submits: a checkout or the Python package.
An extension, which only Blender can import, has the code of a checkout."""


@dataclass(frozen=True, kw_only=True)
class FlamencoSettings(Settings):
    """Choices for a job."""

    flamenco_tasks: int = setting(
        10,
        "Number of tasks that share the takes; more let more workers help",
        label="Tasks",
        minimum=1,
        maximum=10_000,
    )
    flamenco_priority: int = setting(
        50, "Priority among the jobs of the farm", label="Priority", minimum=0, maximum=100
    )


class FlamencoJob(NamedTuple):
    """A batch for a Flamenco Manager; picklable."""

    verb: str
    title: str
    """Name of the takes."""
    manifest: Path
    output_folder: Path
    texts: dict[str, str]
    """The settings of the job type that are options of its verb."""
    options: tuple[str, ...] = ()
    """Words for the end of the command."""
    command: str = COMMAND
    settings: FlamencoSettings = FlamencoSettings()

    @property
    def job_type(self) -> str:
        """Name of its job type."""
        return job_type_of(self.verb)

    @property
    def name(self) -> str:
        """Name in the Manager's list."""
        return f"{self.verb} {self.title}"

    def settings_of_type(self) -> dict[str, Any]:
        """Return a value for each setting of the job type."""
        shared = {
            "manifest": str(self.manifest),
            "output_folder": str(self.output_folder),
            "shards": self.settings.flamenco_tasks,
            "options": shlex.join(self.options),
            "command": self.command,
        }
        of_verb = {"verb": self.verb} if self.job_type == JOB_TYPE else {}
        return {**of_verb, **shared, **self.texts}

    def request(self, etag: str) -> dict[str, Any]:
        """Return the job as the Manager's interface describes it.

        Parameters
        ----------
        etag : str
            Hash of the job type, by which the Manager refuses a job for another version of it.
        """
        return {
            "name": self.name,
            "type": self.job_type,
            "type_etag": etag,
            "priority": self.settings.flamenco_priority,
            "submitter_platform": platform.system().lower(),
            "settings": self.settings_of_type(),
            "metadata": {"mocap_assist.version": version()},
        }


class SubmittedJob(NamedTuple):
    """A job that a Manager has accepted."""

    identifier: str
    page: str
    """Address of its page in the Manager's web interface."""


class CheckedJob(NamedTuple):
    """A job whose Manager has its job type."""

    job: FlamencoJob
    manager: "FlamencoManager"
    etag: str
    """Hash of the job type."""

    def submit(self) -> SubmittedJob:
        """Submit the job.

        Raises
        ------
        InvalidSettingError
            The Manager refuses the job.
        MocapAssistError
            The Manager cannot take it now, or does not answer.
        """
        identifier = self.manager.submit(self.job.request(self.etag))
        return SubmittedJob(identifier, f"{self.manager.address}/app/jobs/{identifier}")


def check_job(job: FlamencoJob, address: str) -> CheckedJob:
    """Check that the Flamenco Manager at an address can take a job; it is not submitted yet.

    Raises
    ------
    InvalidSettingError
        The address is invalid.
    MocapAssistError
        The Manager cannot be reached, is of another version, or has no such job type.
    """
    from .flamenco_manager import FlamencoManager  # and HTTP, which other verbs need not load

    manager = FlamencoManager(address)
    manager.check_version()
    found = manager.job_type(job.job_type)
    script = script_of(job.job_type)
    if found is None:
        raise MocapAssistError(
            f"The Flamenco Manager at {manager.address} has no job type {job.job_type}. Copy"
            f" {script} into the folder scripts next to the Manager."
        )
    if found.keys != job.settings_of_type().keys():
        raise MocapAssistError(
            f"The job type {job.job_type} of the Flamenco Manager at {manager.address} is of"
            f" another version of Mocap Assist. Copy {script} into its folder scripts."
        )
    return CheckedJob(job, manager, found.etag)
