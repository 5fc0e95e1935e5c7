"""Run batches on many machines: workers of a Dask cluster, and jobs for render farms."""

from typing import TYPE_CHECKING

from ...import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .batch_jobs import add_flamenco_options, job_of_batch
    from .cluster import cluster_workers
    from .flamenco_jobs import (
        COMMAND,
        FlamencoJob,
        FlamencoSettings,
        SubmittedJob,
        check_job,
    )
    from .job_types import texts_of_settings

__all__ = [
    "COMMAND",
    "FlamencoJob",
    "FlamencoSettings",
    "SubmittedJob",
    "add_flamenco_options",
    "check_job",
    "cluster_workers",
    "job_of_batch",
    "texts_of_settings",
]

import_on_demand(__name__)
