"""Run batches on many machines: workers of a Dask cluster, and jobs for render farms."""

from .cluster import cluster_workers
from .flamenco_jobs import (
    COMMAND,
    FlamencoJob,
    FlamencoSettings,
    SubmittedJob,
    add_flamenco_options,
    job_of_batch,
    submit_job,
)
from .job_types import texts_of_settings

__all__ = [
    "COMMAND",
    "FlamencoJob",
    "FlamencoSettings",
    "SubmittedJob",
    "add_flamenco_options",
    "cluster_workers",
    "job_of_batch",
    "submit_job",
    "texts_of_settings",
]
