"""Solves in subprocesses: start, poll, cancel, fetch. Independent of Blender."""
