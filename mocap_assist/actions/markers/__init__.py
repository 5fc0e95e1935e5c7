"""Empties that move as captured markers do, made, read and written."""
