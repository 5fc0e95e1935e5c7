"""Measure batches on a cluster."""
