"""Clips in the database of a library, and what goes wrong with it in words."""
