"""A solve in a process of its own: start, ask, cancel, fetch. Knows nothing about Blender."""
