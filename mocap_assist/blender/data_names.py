"""Names that Blender can hold."""

LONGEST = 63
"""Bytes of a name of anything, in the oldest Blender that we run on."""


def fitting_name(name: str) -> str:
    """Return a name cut between letters; Blender would cut it within one, and then stumble."""
    return name.encode("utf-8", "replace")[:LONGEST].decode("utf-8", "ignore")
