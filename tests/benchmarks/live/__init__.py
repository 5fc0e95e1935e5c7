"""Readers, and Blender scenes read and written."""
