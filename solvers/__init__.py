"""Solvers that run without Blender, on arrays and files."""
