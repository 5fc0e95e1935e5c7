"""JSON is refused when it is nested too deeply."""

import json
from contextlib import suppress

import pytest

from solvers.json_text import MAX_DEPTH, parse_json


def nested(depth: int, kind: str = "[]") -> str:
    opening = kind[0] if kind == "[]" else '{"a":'
    return opening * depth + "1" + kind[1] * depth


@pytest.mark.parametrize("value", [{"a": [1, {"b": None}], "c": "[["}, [], 1.5, "x", True])
def test_parse_json_returns_what_was_written(value):
    assert parse_json(json.dumps(value)) == value
    assert parse_json(json.dumps(value).encode("utf-16")) == value


@pytest.mark.parametrize("kind", ["[]", "{}"])
def test_parse_json_refuses_text_when_it_is_nested_too_deeply(kind):
    parse_json(nested(MAX_DEPTH, kind))

    for depth in (MAX_DEPTH + 1, 900, 100_000):
        with pytest.raises(ValueError, match="nested too deeply"):
            parse_json(nested(depth, kind))


@pytest.mark.parametrize("text", ["", "{", b"\xff\xfe\x00", "[1,]", "1" * 5000])
def test_parse_json_refuses_invalid_json(text):
    with pytest.raises(ValueError, match=r"."):
        parse_json(text)


@pytest.mark.parametrize("text", ["[" * 99, '\\"' + "[" * 99, "\\", '"', "]" * 99])
def test_parse_json_ignores_brackets_in_strings(text):
    assert parse_json(json.dumps([text])) == [text]

    hidden = f"[{json.dumps(text)}, {nested(MAX_DEPTH)}]"
    with pytest.raises(ValueError, match="nested too deeply"):
        parse_json(hidden)


@pytest.mark.parametrize(
    "text",
    ["[" + "[]," * 10**6 + "[]]", '"' + '\\"' * 10**6, '["' * 10**6, "[" * 10**6],
    ids=["lists", "quotes", "strings", "open"],
)
def test_parse_json_comes_to_an_end_with_any_text(text):
    with suppress(ValueError):  # Quadratic time would outlast the time limit of all tests.
        parse_json(text)
