"""Texts of the window that stand in the source: what panels draw, and sentences."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from string import Formatter

FOLDERS = ("mocap_assist", "operators")
NOT_SHOWN = ("mocap_assist/batch/", "mocap_assist/languages/")
"""Verbs of the command line, whose texts are English, and what this is about."""
CONSTANTS = {
    "mocap_assist/check/compare_panel.py": {"HOLD"},
    "mocap_assist/check/held_operator.py": {"HELD", "CLICKED"},
    "mocap_assist/drawing/strip_ranges.py": {"Row", "Mark"},
    "mocap_assist/exporting/export_menu.py": {"ENTRY"},
    "mocap_assist/importing/import_menu.py": {"ENTRY"},
    "mocap_assist/live/listening.py": {"MODES"},
    "mocap_assist/panels/figure_rows.py": {"FIGURES"},
}
"""By file: constants and enums whose texts are labels, but no sentences."""
TAKES_TEXT = {"translated": 0, "pgettext_iface": 0, "draw_sentence": 2, "progress": 1,
              "poll_message_set": 0, "_in_slices": 0}  # fmt: skip
"""By function: the argument that is a text of the window."""
SENTENCE = re.compile(r"[A-Z{\"'(].* .*(\.|\.\.\.|!)", re.DOTALL)
LABEL = re.compile(r"[A-Z{].*")
MIN_LETTERS = 6
"""Letters outside of placeholders from which a text can be recognized once these are filled
in."""
NAME = re.compile(r"\b[a-z_]\w*")
NO_NAMES = re.compile(r"'[^']*'|\"[^\"]*\"|\[.*?\]|\b(if|else|or|and|not|for|in)\b")
VAGUE = {"name", "path", "self", "len", "join", "str", "parent", "value", "action", "shown",
         "strip", "resolve", "capitalize", "max", "min", "round"}  # fmt: skip
"""Words of an expression that do not describe a placeholder where another word does."""


def source_texts(root: Path) -> set[str]:
    """Return the texts in the source below a folder."""
    found: set[str] = set()
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*.py")):
            name = path.relative_to(root).as_posix()
            if not name.startswith(NOT_SHOWN):
                tree = ast.parse(path.read_text(encoding="utf-8"))
                found |= set(_texts(tree, CONSTANTS.get(name, set())))
    return {text for text in found if _n_letters(text) >= _min_letters(text)}


def _texts(tree: ast.Module, constants: set[str]) -> Iterator[str]:
    ignored = {id(node) for node in _not_shown(tree)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            for argument in _text_arguments(node):
                yield from _strings(argument)
        elif isinstance(node, ast.JoinedStr | ast.Constant) and id(node) not in ignored:
            text = _text(node)
            if SENTENCE.fullmatch(text):
                yield text
    for node in tree.body:
        if _name_of(node) in constants:
            for each in ast.walk(node):
                if isinstance(each, ast.Constant) and id(each) not in ignored:
                    yield from LABEL.findall(_text(each))


def _not_shown(tree: ast.Module) -> Iterator[ast.AST]:
    """Yield docstrings, texts of classes, which Blender knows, and parts of other texts."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr):
            yield node.value
        elif isinstance(node, ast.JoinedStr):
            yield from node.values
        elif isinstance(node, ast.keyword) and node.arg in {"description", "name"}:
            yield from ast.walk(node.value)
        elif isinstance(node, ast.Assign) and _name_of(node).startswith("bl_"):
            yield from ast.walk(node.value)


def _text_arguments(call: ast.Call) -> Iterator[ast.expr]:
    for keyword in call.keywords:
        if keyword.arg == "text":
            yield keyword.value
    function = call.func
    name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
    position = TAKES_TEXT.get(name)
    if position is not None and position < len(call.args):
        yield call.args[position]


def _strings(node: ast.expr) -> Iterator[str]:
    """Yield the text, or both texts of a choice."""
    if isinstance(node, ast.IfExp):
        yield from _strings(node.body)
        yield from _strings(node.orelse)
    elif isinstance(node, ast.JoinedStr | ast.Constant) and (text := _text(node)):
        yield text


def _name_of(node: ast.stmt) -> str:
    if isinstance(node, ast.ClassDef):
        return node.name
    if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
        return node.targets[0].id
    if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
        return node.target.id
    return ""


def _text(node: ast.Constant | ast.JoinedStr) -> str:
    """Return a text, with a named placeholder for each expression; empty for other constants."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else ""
    parts, used = [], []
    for value in node.values:
        if isinstance(value, ast.FormattedValue):
            used.append(_placeholder(value.value, used))
            parts.append(f"{{{used[-1]}}}")
        else:
            parts.append(str(value.value).replace("{", "{{").replace("}", "}}"))
    return "".join(parts)


def _placeholder(expression: ast.expr, used: list[str]) -> str:
    words = NAME.findall(NO_NAMES.sub("", ast.unparse(expression)))
    clear = [word for word in words if word not in VAGUE] or words or ["value"]
    name = clear[-1].strip("_")
    n_before = sum(1 for each in used if each.rstrip("0123456789") == name)
    return f"{name}{n_before + 1}" if n_before else name


def _n_letters(text: str) -> int:
    literal = "".join(part for part, *_ in Formatter().parse(text))
    return sum(letter.isalpha() for letter in literal)


def _min_letters(text: str) -> int:
    return MIN_LETTERS if "{" in text else 1
