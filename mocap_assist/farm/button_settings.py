"""Settings of Submit Folder: those of Fix My Take, and of the job."""

from typing import NamedTuple

from ...solvers.command_line.farm import FlamencoSettings
from ...solvers.workflows import FixSettings


class FarmBundle(NamedTuple):
    """Settings of the button."""

    job: FlamencoSettings
    fixing: FixSettings
