"""Read JSON that anybody may have written."""

import json
import re
from typing import Any

import numpy as np

MAX_DEPTH = 64
"""Lists and objects within each other; files of this project and of cameras have up to 8."""
STRING = re.compile(r'"(?:[^"\\]++|\\.)*+(?:"|\\?\Z)', re.DOTALL)
"""One that does not end goes on to the end of the text, so that it is looked at once."""


def parse_json(text: str | bytes, **options: Any) -> Any:
    """Return what JSON text holds; options are those of `json.loads`.

    Raises
    ------
    ValueError
        The text is not JSON, or its lists and objects are nested more than `MAX_DEPTH` deep,
        more than code that writes or walks through them can bear.
    """
    if isinstance(text, bytes):
        text = text.decode(json.detect_encoding(text), "surrogatepass")
    if _depth(text) > MAX_DEPTH:
        raise ValueError("it is nested too deeply")
    return json.loads(text, **options)


def _depth(text: str) -> int:
    """Return how deeply lists and objects are nested in JSON text, at least."""
    letters = np.frombuffer(STRING.sub("", text).encode("utf-8", "replace"), np.uint8)
    opened = (letters == ord("[")) | (letters == ord("{"))
    closed = (letters == ord("]")) | (letters == ord("}"))
    steps = np.where(opened[opened | closed], 1, -1)
    return int(np.cumsum(steps).max(initial=0))
