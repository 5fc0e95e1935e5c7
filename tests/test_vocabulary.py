"""Names and texts use the terms of the field: docs/glossary.md.

To retire a word, replace it everywhere and add it to one table below or to both: some words are
wrong in names, where they hide what a value is, and right in a sentence.
"""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
CODE = ("operators", "mocap_assist", "solvers")
RETIRED_IN_TEXTS = {
    "albeit": "although",
    "amiss": "wrong",
    "companion": "reference marker",
    "companions": "reference markers",
    "foresight": "prediction, leave-one-out error",
    "girdle": "clavicle, shoulder girdle joint",
    "girdles": "clavicles, shoulder girdle joints",
    "gives way": "is offset, is relaxed",
    "glimpse": "preview",
    "glimpses": "previews",
    "hitherto": "until now",
    "in vain": "without effect",
    "lest": "so that ... not",
    "licence": "license",
    "likeness": "similarity",
    "likes": "neighbors, similar clips",
    "needs an eye": "issue",
    "neighbour": "neighbor",
    "onlookers": "observers",
    "puts right": "corrects",
    "reckon": "compute",
    "spoilt": "corrupted, damaged",
    "steadying": "smoothing",
    "thereof": "of it",
    "trust in colors": "confidence colors",
    "unsure": "low confidence",
    "whence": "where ... from",
    "whither": "where",
    "whilst": "while",
}
"""What users do not read any more, and what they read instead: in README.md, CONTRIBUTING.md,
docs, the manual, and every text of the code that is no docstring: labels, tooltips, help,
messages and errors. A phrase of several words is one entry."""
RETIRED_IN_NAMES = {
    "colour": "color",
    "colours": "colors",
    "companion": "reference marker",
    "foretells": "predicts",
    "girdle": "clavicle",
    "lest": "until, unless",
    "mended": "corrected, repaired",
    "neighbour": "neighbor",
    "reckon": "compute",
    "spoilt": "corrupted, damaged",
    "surer": "confidence",
    "whither": "target, heading",
    "whoever": "user, actor",
}
"""What no module, class, function, argument, attribute or variable of the code is called any
more, as a word of its name, and what is used instead."""
WORD = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+")


@cache
def texts() -> tuple[tuple[str, str], ...]:
    """Where each text for users stands, and the text."""
    pages = [
        ROOT / "README.md",
        ROOT / "CONTRIBUTING.md",
        *sorted((ROOT / "docs").rglob("*.md")),
        *sorted((ROOT / "mocap_assist").rglob("*.html")),
        *sorted((ROOT / "solvers").rglob("*.html")),
    ]
    lines = [
        (f"{page.relative_to(ROOT)}:{number}", line)
        for page in pages
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1)
    ]
    strings = [
        (f"{module.relative_to(ROOT)}:{node.lineno}", node.value)
        for module, tree in modules()
        for node in strings_of(tree)
    ]
    return *lines, *strings


@cache
def names() -> dict[str, str]:
    """Each word of a name in the code, and one place where it stands."""
    found: dict[str, str] = {}
    for module, tree in modules():
        path = module.relative_to(ROOT)
        for part in path.with_suffix("").parts:
            found |= {word.lower(): f"{path}" for word in WORD.findall(part)}
        for line, name in names_of(tree):
            place = f"{path}:{line} {name}"
            found |= {word.lower(): place for word in WORD.findall(name)}
    return found


@cache
def modules() -> tuple[tuple[Path, ast.Module], ...]:
    paths = [path for folder in CODE for path in sorted((ROOT / folder).rglob("*.py"))]
    return tuple((path, ast.parse(path.read_text(encoding="utf-8"))) for path in paths)


def strings_of(tree: ast.Module) -> Iterator[ast.Constant]:
    """Texts that stand in an expression; docstrings are statements of their own."""
    statements = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        is_text = isinstance(node, ast.Constant) and isinstance(node.value, str)
        if is_text and id(node) not in statements:
            yield node


def names_of(tree: ast.Module) -> Iterator[tuple[int, str]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield node.lineno, node.name
        elif isinstance(node, ast.arg):
            yield node.lineno, node.arg
        elif isinstance(node, ast.Name):
            yield node.lineno, node.id
        elif isinstance(node, ast.Attribute):
            yield node.lineno, node.attr


@pytest.mark.parametrize("retired", RETIRED_IN_TEXTS)
def test_texts_for_users_have_no_retired_word(retired):
    pattern = re.compile(rf"(?<![\w-]){re.escape(retired)}(?![\w-])", re.IGNORECASE)
    places = [place for place, text in texts() if pattern.search(text)]

    assert not places, f"instead of {retired!r} write: {RETIRED_IN_TEXTS[retired]}"


@pytest.mark.parametrize("retired", RETIRED_IN_NAMES)
def test_names_have_no_retired_word(retired):
    place = names().get(retired)

    assert place is None, f"instead of {retired!r} write: {RETIRED_IN_NAMES[retired]}"


def test_texts_and_names_are_collected():
    """What the other tests look through is there at all."""
    assert any("Clean" in text for place, text in texts() if place.startswith("operators"))
    assert {"denoise", "skeleton", "settings"} <= set(names())
    assert [node.value for node in strings_of(ast.parse('"""Doc."""\nx = "text"'))] == ["text"]
    named = {name for _, name in names_of(ast.parse("def f(a): b.c = d"))}
    assert named == {"f", "a", "b", "c", "d"}
