"""Actions as motions and markers as tracks, read and written in bulk."""
