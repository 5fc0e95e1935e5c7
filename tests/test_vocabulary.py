"""Names and texts use the terms of the field: docs/glossary.md.

To retire a word, replace it everywhere and add it to one table of `retired_words.py` or to
both: some words are wrong in names, where they hide what a value is, and right in a sentence.
"""

import ast
import gc
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from tests.retired_words import (
    RETIRED_FIRST_WORDS,
    RETIRED_IN_NAMES,
    RETIRED_IN_TEXTS,
    STORED_NAMES,
)

ROOT = Path(__file__).parents[1]
CODE = ("operators", "mocap_assist", "solvers")
TESTS = ("tests", ".ci")
WORD = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+")


@cache
def texts() -> tuple[tuple[str, str], ...]:
    """Where each text stands, and the text."""
    pages = [
        *sorted(ROOT.glob("*.md")),
        ROOT / "Makefile",
        ROOT / "pyproject.toml",
        *sorted(path for path in (ROOT / ".ci").rglob("*") if is_text(path)),
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
        for module, tree in modules(CODE)
        for node in strings_of(tree)
    ]
    docstrings = [
        (f"{module.relative_to(ROOT)}:{node.lineno}", node.value)
        for module, tree in modules(("tests",))
        for node in docstrings_of(tree)
    ]
    comments = [
        (f"{module.relative_to(ROOT)}:{number}", comment)
        for module, _ in modules((*CODE, "tests"))
        for number, comment in comments_of(module)
    ]
    return *lines, *strings, *docstrings, *comments


def is_text(path: Path) -> bool:
    """Whether a file of `.ci` is a script or page, and no lock file or compiled module."""
    return path.is_file() and path.suffix in {"", ".css", ".html", ".js", ".py"}


def comments_of(module: Path) -> Iterator[tuple[int, str]]:
    """What follows a # in each line; in a string this is a text, too."""
    for number, line in enumerate(module.read_text(encoding="utf-8").splitlines(), 1):
        if "#" in line:
            yield number, line.partition("#")[2]


def docstrings_of(tree: ast.Module) -> Iterator[ast.Constant]:
    """Strings that are statements: docstrings, also those of constants."""
    for node in ast.walk(tree):
        match node:
            case ast.Expr(value=ast.Constant(value=str()) as text):
                yield text


@cache
def names() -> dict[str, str]:
    """Each word of a name in the code and its tests, and one position where it stands."""
    found: dict[str, str] = {}
    for module, tree in modules(CODE + TESTS):
        path = module.relative_to(ROOT)
        for part in path.with_suffix("").parts:
            found |= {word.lower(): f"{path}" for word in WORD.findall(part)}
        for line, name in names_of(tree):
            if name in STORED_NAMES:
                continue
            where = f"{path}:{line} {name}"
            found |= {word.lower(): where for word in WORD.findall(name)}
    return found


def modules(folders: tuple[str, ...]) -> Iterator[tuple[Path, ast.Module]]:
    for folder in folders:
        yield from parsed(folder)


@cache
def parsed(folder: str) -> tuple[tuple[Path, ast.Module], ...]:
    paths = sorted((ROOT / folder).rglob("*.py"))
    gc.disable()  # it would search millions of nodes again and again
    trees = tuple((path, ast.parse(path.read_text(encoding="utf-8"))) for path in paths)
    gc.enable()
    return trees


def strings_of(tree: ast.Module) -> Iterator[ast.Constant]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node


NAME_FIELDS: dict[type[ast.AST], str] = {
    ast.FunctionDef: "name", ast.AsyncFunctionDef: "name", ast.ClassDef: "name",
    ast.arg: "arg", ast.keyword: "arg", ast.Name: "id", ast.Attribute: "attr",
    ast.alias: "asname", ast.ExceptHandler: "name", ast.MatchAs: "name",
}  # fmt: skip
"""Field of a node of the syntax tree that holds its name."""


def names_of(tree: ast.Module) -> Iterator[tuple[int, str]]:
    for node in ast.walk(tree):
        field = NAME_FIELDS.get(type(node))
        name = field and getattr(node, field)
        if name:
            yield node.lineno, name


def constants_of(tree: ast.Module) -> Iterator[str]:
    """Names in capitals that a module assigns."""
    for node in tree.body:
        if isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            for target in targets:
                names = (each.id for each in ast.walk(target) if isinstance(each, ast.Name))
                yield from (name for name in names if name.isupper())


@cache
def joined_texts() -> str:
    return "\n".join(text for _, text in texts()).lower()


@pytest.mark.parametrize("retired", RETIRED_IN_TEXTS)
def test_texts_have_no_retired_word(retired):
    word = re.escape(retired)  # first in the pattern, which makes the search fast
    pattern = re.compile(rf"{word}(?<![\w-]{word})(?![\w-])")
    positions = []
    if pattern.search(joined_texts()):
        positions = [where for where, text in texts() if pattern.search(text.lower())]

    assert not positions, (
        f"instead of {retired!r} write: {RETIRED_IN_TEXTS[retired]}; see {positions}"
    )


@pytest.mark.parametrize("retired", RETIRED_IN_NAMES)
def test_names_have_no_retired_word(retired):
    position = names().get(retired)

    assert position is None, (
        f"{position}: instead of {retired!r} write: {RETIRED_IN_NAMES[retired]}"
    )


@pytest.mark.parametrize("folders", [CODE, TESTS], ids=["code", "tests"])
def test_constants_begin_with_no_superlative(folders):
    superlatives = [
        f"{module.relative_to(ROOT)}: {name}"
        for module, tree in modules(folders)
        for name in constants_of(tree)
        if name.strip("_").partition("_")[0] in RETIRED_FIRST_WORDS
    ]

    assert not superlatives, "write MAX_ or MIN_, a noun, and a unit"


def test_stored_names_are_in_use():
    used = {name for _, tree in modules(CODE) for _, name in names_of(tree)}

    assert used >= STORED_NAMES


def test_texts_and_names_are_collected():
    """What the other tests look through is there at all."""
    assert any("Clean" in text for where, text in texts() if where.startswith("operators"))
    assert {"denoise", "skeleton", "settings", "fixtures"} <= set(names())
    found = [node.value for node in strings_of(ast.parse('"""Doc."""\nx = "text"'))]
    assert found == ["Doc.", "text"]
    assert [node.value for node in docstrings_of(ast.parse('"""Doc."""\nx = "text"'))] == [
        "Doc."
    ]
    described = {where.partition(":")[0] for where, _ in texts()}
    assert described >= {"CHANGELOG.md", "Makefile", ".ci/run", "tests/test_vocabulary.py"}
    assert (
        " fmt: skip" in dict(comments_of(Path(__file__).with_name("retired_words.py"))).values()
    )
    named = {name for _, name in names_of(ast.parse("def f(a): b.c = d"))}
    assert named == {"f", "a", "b", "c", "d"}
    assert [*constants_of(ast.parse("A, B = 1, 2\nC: int = 3\nd = 4"))] == ["A", "B", "C"]
