"""Clips, noise, tables, plots and reports of all benchmarks."""
