"""Run batches on many machines: workers of a Dask cluster, and jobs for render farms."""

from .cluster import cluster_workers

__all__ = ["cluster_workers"]
