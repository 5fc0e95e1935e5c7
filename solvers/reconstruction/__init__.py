"""Rebuild clean poses from what a depth camera's tracker saw."""
