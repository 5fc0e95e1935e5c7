"""Read JSON that anybody may have written."""

import json
from typing import Any

MAX_DEPTH = 64
"""Lists and objects within each other; files of this project and of cameras have up to 8."""


def parse_json(text: str | bytes, **options: Any) -> Any:
    """Return what JSON text holds; options are those of `json.loads`.

    Raises
    ------
    ValueError
        The text is no JSON, or its lists and objects are nested more than `MAX_DEPTH` deep,
        which whoever writes or walks through them could not bear.
    """
    try:
        value = json.loads(text, **options)
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
    level = [value]
    for _ in range(MAX_DEPTH):
        level = [part for each in level for part in _parts(each)]
        if not level:
            return value
    raise ValueError("it is nested too deeply")


def _parts(value: Any) -> list[Any]:
    """Return the lists and objects in a value."""
    inside = value.values() if isinstance(value, dict) else value
    if not isinstance(value, dict | list):
        return []
    return [each for each in inside if isinstance(each, dict | list)]
