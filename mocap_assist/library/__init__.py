"""Clips from folders, .blend files and asset libraries, and what is done with them."""
