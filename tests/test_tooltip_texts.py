"""Tooltips in the code are one sentence that Blender shows in one glance.

This reads the source and needs no Blender; tests/blender/ui/test_tooltips.py asks Blender for
the tooltips that it shows.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
CODE = ("operators", "mocap_assist", "solvers")
CATALOG = ROOT / "mocap_assist" / "languages" / "de_DE.po"
MAX_TOOLTIP = 90
MAX_MESSAGE = 180
"""Characters of a message with placeholders for its names and figures. Chosen by hand: the
longest has 174; a status bar is one line."""
TWO_SENTENCES = re.compile(r"[.!?] [A-Z]")


def tooltips_of(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """The tooltips of buttons, properties, settings and choices that are plain strings."""
    for node in ast.walk(tree):
        found: list[ast.expr] = []
        if isinstance(node, ast.Call):
            found = tooltips_of_call(node)
        elif isinstance(node, ast.ClassDef):
            found = tooltips_of_class(node)
        for each in found:
            if isinstance(each, ast.Constant) and isinstance(each.value, str):
                yield each.lineno, each.value


def tooltips_of_call(call: ast.Call) -> list[ast.expr]:
    """Of `setting(default, help)` and of `bpy.props.SomeProperty(description=help)`."""
    if getattr(call.func, "id", "") == "setting":
        return call.args[1:2]
    if getattr(call.func, "attr", "").endswith("Property"):
        return [each.value for each in call.keywords if each.arg == "description"]
    return []


def tooltips_of_class(given: ast.ClassDef) -> list[ast.expr]:
    """Of buttons, and of the members of a `Choice`."""
    assigned = [line for line in given.body if isinstance(line, ast.Assign)]
    if any(getattr(base, "id", "") == "Choice" for base in given.bases):
        tuples = [line.value for line in assigned if isinstance(line.value, ast.Tuple)]
        return [each.elts[1] for each in tuples]
    return [
        line.value
        for line in assigned
        if getattr(line.targets[0], "id", "") == "bl_description"
    ]


def all_tooltips() -> list[tuple[str, str]]:
    return [
        (f"{path.relative_to(ROOT)}:{line}", text)
        for folder in CODE
        for path in sorted((ROOT / folder).rglob("*.py"))
        for line, text in tooltips_of(ast.parse(path.read_text(encoding="utf-8")))
    ]


TOOLTIPS = all_tooltips()


def test_tooltips_are_short():
    long = [(where, len(text), text) for where, text in TOOLTIPS if len(text) > MAX_TOOLTIP]

    assert not long


def test_tooltips_are_one_sentence_without_a_period():
    wrong = [
        (where, text)
        for where, text in TOOLTIPS
        if TWO_SENTENCES.search(text) or text.endswith(".")
    ]
    assert not wrong


def test_messages_fit_the_status_bar():
    messages = re.findall(r'^msgid "(.*)"$', CATALOG.read_text(encoding="utf-8"), re.MULTILINE)

    assert len(messages) > 1000
    assert not [text for text in messages if len(text) > MAX_MESSAGE]


@pytest.mark.parametrize(
    "source",
    [
        'class A(Operator):\n    bl_description = "Found"',
        'class A(Choice):\n    ONE = "one", "Found", "One"',
        'class A(Settings):\n    a: int = setting(1, "Fo" "und", minimum=0)',
        'a = bpy.props.BoolProperty(name="A", description="Found")',
    ],
)
def test_tooltips_are_collected(source):
    assert [text for _, text in tooltips_of(ast.parse(source))] == ["Found"]
    assert len(TOOLTIPS) > 400
