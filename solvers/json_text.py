"""Parse untrusted JSON."""

import json
import re
from typing import Any

import numpy as np

MAX_DEPTH = 64
"""Maximum nesting of lists and objects; files of this project and of cameras have up to 8."""
STRING = re.compile(r'"(?:[^"\\]++|\\.)*+(?:"|\\?\Z)', re.DOTALL)
"""An unterminated string matches to the end of the text, which bounds the run time."""


def parse_json(text: str | bytes, **options: Any) -> Any:
    """Parse JSON text; options are those of `json.loads`.

    Raises
    ------
    ValueError
        The text is not JSON, or its lists and objects are nested more than `MAX_DEPTH` deep,
        which would overflow recursive code.
    """
    if isinstance(text, bytes):
        text = text.decode(json.detect_encoding(text), "surrogatepass")
    if _depth(text) > MAX_DEPTH:
        raise ValueError("it is nested too deeply")
    return json.loads(text, **options)


def _depth(text: str) -> int:
    """Return a lower bound of the nesting of lists and objects in JSON text."""
    letters = np.frombuffer(STRING.sub("", text).encode("utf-8", "replace"), np.uint8)
    opened = (letters == ord("[")) | (letters == ord("{"))
    closed = (letters == ord("]")) | (letters == ord("}"))
    steps = np.where(opened[opened | closed], 1, -1)
    return int(np.cumsum(steps).max(initial=0))
