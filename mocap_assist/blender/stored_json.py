"""Read and write JSON in custom properties, which users may have edited."""

import json
from collections.abc import Mapping, Sequence
from functools import lru_cache
from math import isfinite
from typing import Any, overload

import bpy

from ...solvers.json_text import parse_json

MAX_CACHED = 32
"""Number of cached values. It bounds the memory."""


def store_json(holder: Any, key: str, value: dict[str, Any] | list[Any]) -> None:
    """Store a value in a custom property of a data-block or bone."""
    holder[key] = json.dumps(value, ensure_ascii=False)


@overload
def load_json(
    holder: bpy.types.ID, key: str, kind: type[dict[str, Any]]
) -> Mapping[str, Any]: ...
@overload
def load_json(holder: bpy.types.ID, key: str, kind: type[list[Any]]) -> Sequence[Any]: ...
def load_json(holder: bpy.types.ID, key: str, kind: type[Any]) -> Any:
    """Return a value of `store_json`; an empty list or dictionary if there is none.

    Infinities, NaN and numbers that overflow to infinity count as damage. A text is parsed
    once, since panels ask for it at each redraw: the value must not be changed.
    """
    return parse_stored(str(holder.get(key)), kind)


def parse_stored(text: str, kind: type[Any]) -> Any:
    """Parse a text like `load_json`."""
    value = _parsed(text)
    return value if isinstance(value, kind) else kind()


@lru_cache(MAX_CACHED)
def _parsed(text: str) -> Any:
    """Return the value of a text; None if it is damaged."""
    try:
        return parse_json(
            text, parse_constant=_finite_number, parse_float=_finite_number, parse_int=_integer
        )
    except ValueError:
        return None


def _finite_number(text: str) -> float:
    if not isfinite(number := float(text)):
        raise ValueError(text)
    return number


def _integer(text: str) -> int:
    _finite_number(text)  # too large for float arithmetic otherwise
    return int(text)
