"""Run batches on many machines: workers of a Dask cluster, and jobs for render farms."""

from .cluster import cluster_workers
from .workers import LocalWorkers, Workers

__all__ = ["LocalWorkers", "Workers", "cluster_workers"]
