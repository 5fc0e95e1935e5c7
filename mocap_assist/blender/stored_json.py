"""Read and write JSON in custom properties, which users may have edited."""

import json
from math import isfinite
from typing import Any, TypeVar

import bpy

from ...solvers.json_text import parse_json

Kind = TypeVar("Kind", dict[str, Any], list[Any])


def store_json(holder: Any, key: str, value: dict[str, Any] | list[Any]) -> None:
    """Store a value in a custom property of a data-block or bone."""
    holder[key] = json.dumps(value, ensure_ascii=False)


def load_json(holder: bpy.types.ID, key: str, kind: type[Kind]) -> Kind:
    """Return a value of `store_json`; an empty list or dictionary if there is none.

    Infinities, NaN and numbers that overflow to infinity count as damage.
    """
    return parse_stored(holder.get(key), kind)


def parse_stored(text: object, kind: type[Kind]) -> Kind:
    """Parse a text like `load_json`."""
    try:
        value = parse_json(
            str(text), parse_constant=_finite, parse_float=_finite, parse_int=_integer
        )
    except ValueError:
        return kind()
    return value if isinstance(value, kind) else kind()


def _finite(text: str) -> float:
    if not isfinite(number := float(text)):
        raise ValueError(text)
    return number


def _integer(text: str) -> int:
    _finite(text)  # too large for float arithmetic otherwise
    return int(text)
