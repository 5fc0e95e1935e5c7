"""Lists of names in one text property: `walk; run; C:/clips`."""

from collections.abc import Iterable

SEPARATOR = ";"
CHANGES_A_LIST = {"INTERNAL", "UNDO"}
"""`bl_options` of the operators that add to such a list or remove from it."""


def split_names(text: str) -> list[str]:
    """Return the names in a list."""
    return [name.strip() for name in text.split(SEPARATOR) if name.strip()]


def join_names(names: Iterable[str]) -> str:
    """Return names as one list, each once."""
    return f"{SEPARATOR} ".join(dict.fromkeys(names))
