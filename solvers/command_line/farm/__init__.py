"""Run batches on many machines: workers of a Dask cluster, and jobs for render farms."""

from .cluster import cluster_workers
from .flamenco_jobs import (
    COMMAND,
    FlamencoJob,
    FlamencoSettings,
    SubmittedJob,
    add_flamenco_options,
    check_job,
    job_of_batch,
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
