"""Reconstruct and its parts, on recordings with known truth."""
