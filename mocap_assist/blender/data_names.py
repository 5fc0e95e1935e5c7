"""Names that Blender can hold."""

MAX_NAME_BYTES = 63
"""Limit for names of data-blocks and bones in Blender 4.5."""


def fitting_name(name: str) -> str:
    """Return a name cut between characters; Blender would cut within one and then fail."""
    return name.encode("utf-8", "replace")[:MAX_NAME_BYTES].decode("utf-8", "ignore")
