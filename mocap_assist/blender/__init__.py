"""Adapters to Blender: versions, names, paths, properties, time slices."""
