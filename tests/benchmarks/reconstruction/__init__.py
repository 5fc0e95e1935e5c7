"""Reconstruct and its parts, on recordings with ground truth."""
