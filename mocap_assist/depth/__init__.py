"""Depth recordings as points that follow the timeline."""
