"""Texts of the window that stand in the source: what panels draw, and sentences."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from string import Formatter

from labels import LABELED, TERMS

FOLDERS = ("mocap_assist", "operators", "solvers")
NOT_SHOWN = (
    "mocap_assist/batch/", "solvers/command_line/",  # in English
    "mocap_assist/languages/", "mocap_assist/ui/diagnostics.py",
    "solvers/samples/", "solvers/pictures/", "solvers/processes/",
    "solvers/depth_tracking/forest/", "solvers/depth_tracking/forest_training/",
    "solvers/reconstruction/residual_correction/learn_", "solvers/rotations/",
    "solvers/retrieval/index/", "solvers/retrieval/library/values.py",
    "solvers/retrieval/find_in_libraries.py",
    "solvers/retrieval/library/clip_rows.py",
    *(f"solvers/recordings/streams/{name}.py"
      for name in ("frames/joint_frames", "senders")),
    *(f"solvers/recordings/streams/protocols/{name}.py"
      for name in ("axes", "layouts", "lz4", "mocopi", "osc", "rokoko", "vmc")),
    "solvers/motion/skeletons/skeleton.py", "solvers/motion/skeletons/limb_ik.py",
    "solvers/motion/skeletons/warping.py", "solvers/motion/skeletons/joint_recording.py",
    "solvers/motion/skeletons/joint_limits.py",
)  # fmt: skip
"""Beginnings of paths without texts of the window: verbs of the command line, what translates,
scripts that learn, damaged packets of streams, and checks of arrays that only programs and
damaged libraries fail."""
SHOWN = ("solvers/command_line/farm/flamenco_",)
"""Beginnings of paths among those whose texts Submit Folder shows."""
TAKES_TEXT = {
    "translated": 0, "pgettext_iface": 0, "poll_message_set": 0, "_in_slices": 0,
    "progress": 1, "draw_sentence": 2, "Remark": 0,
}  # fmt: skip
"""By function: the argument that is a text of the window."""
SENTENCE = re.compile(r"\A[A-Z0-9{\"'(].* .*[.!]\Z", re.DOTALL)
REMARK = re.compile(r"\A[A-Z][a-z]+(?=(?:.*?\b[a-z]{2,}\b){4}).*\w[\"')}]?\Z", re.DOTALL)
"""A sentence without a period, as remarks of readers are: four words of small letters."""
SENTENCE_END = re.compile(r"(?<=[.!?]) (?=\S)")
"""Where messages of solvers are parted: many have a sentence in common, such as "Export it
again."."""
OTHER_SENTENCE = re.compile(r"(?<=[.!]) ?\{\w+\}$")
"""A placeholder at the end for a sentence, which is translated by itself."""
ARRAYS = re.compile(r"\bshapes?\b")
"""A word of messages about arrays, which programs cause and not the window."""
LABEL = re.compile(r"[A-Z].*|.*\{.*|[0-9]+ .*|.* .*", re.DOTALL)
TERM = re.compile(r".+")
MIN_LETTERS = 4
"""Letters outside of placeholders from which a text is recognized once these are filled in."""
WORDS = re.compile(r"'[^']*'|\"[^\"]*\"|\[.*?\]|\b(if|else|or|and|not|for|in)\b|\b([a-z_]\w*)")
VAGUE = {
    "action", "capitalize", "join", "len", "max", "min", "name", "parent", "path", "resolve",
    "round", "self", "shown", "str", "strip", "value",
}  # fmt: skip
"""Words of an expression that do not describe a placeholder where another word does."""


def source_texts(root: Path) -> set[str]:
    """Return the texts in the source below a folder."""
    found: set[str] = set()
    for path in _files(root):
        name = path.relative_to(root).as_posix()
        if name.startswith(SHOWN) or not name.startswith(NOT_SHOWN):
            tree = ast.parse(path.read_text(encoding="utf-8"))
            hidden = {id(node) for node in _not_shown(tree)}
            shown = [node for node in ast.walk(tree) if id(node) not in hidden]
            arguments = set(_arguments(shown))
            sentences = set(_sentences(shown))
            if not name.endswith("settings.py"):
                sentences |= set(_remarks(tree, shown)) - arguments
            if name.startswith("solvers"):
                sentences = {each for text in sentences for each in SENTENCE_END.split(text)}
            found |= arguments | sentences
            found |= set(_labels(tree, hidden, LABELED.get(name, set()), LABEL))
            found |= set(_labels(tree, hidden, TERMS.get(name, set()), TERM))
    return {text for text in found if _can_be_recognized(text)}


def _files(root: Path) -> list[Path]:
    return [path for folder in FOLDERS for path in sorted((root / folder).rglob("*.py"))]


def _arguments(nodes: list[ast.AST]) -> Iterator[str]:
    """Yield what is given to functions that show it."""
    for node in nodes:
        if isinstance(node, ast.Call):
            for argument in _text_arguments(node):
                yield from _strings(argument)


def _sentences(nodes: list[ast.AST]) -> Iterator[str]:
    for node in nodes:
        if isinstance(node, ast.JoinedStr | ast.Constant):
            text = OTHER_SENTENCE.sub("", _text(node).strip())
            yield from SENTENCE.findall(text)


def _remarks(tree: ast.Module, nodes: list[ast.AST]) -> Iterator[str]:
    """Yield sentences without a period that are no help of settings and no line of a log."""
    others = {id(node) for other in ast.walk(tree) if _is_never_shown(other)
              for node in ast.walk(other)}  # fmt: skip
    for node in nodes:
        if isinstance(node, ast.JoinedStr | ast.Constant) and id(node) not in others:
            yield from REMARK.findall(OTHER_SENTENCE.sub("", _text(node).strip()))


def _is_never_shown(node: ast.AST) -> bool:
    """Whether this describes a setting, which Blender knows, or writes to a log or database."""
    if isinstance(node, ast.ClassDef):
        return any(getattr(base, "id", "") == "Choice" for base in node.bases)
    if not isinstance(node, ast.Call):
        return False
    called = node.func
    name = called.attr if isinstance(called, ast.Attribute) else getattr(called, "id", "")
    owner = getattr(getattr(called, "value", None), "id", "")
    return name in {"setting", "execute", "executescript"} or owner == "logger"


def _labels(
    tree: ast.Module, hidden: set[int], names: set[str], kind: re.Pattern[str]
) -> Iterator[str]:
    """Yield all texts of these constants, classes and functions."""
    for outer in ast.walk(tree):
        for node in ast.walk(outer) if _name_of(outer) in names else ():
            if isinstance(node, ast.JoinedStr | ast.Constant) and id(node) not in hidden:
                yield from kind.findall(_text(node))


def _not_shown(tree: ast.Module) -> Iterator[ast.AST]:
    """Yield docstrings, texts of classes, which Blender knows, and parts of other texts."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            yield node.value
        elif isinstance(node, ast.JoinedStr):
            yield from (each for value in node.values for each in ast.walk(value))
        elif _describes_class(node):
            yield from ast.walk(node)


def _describes_class(node: ast.AST) -> bool:
    """Whether this is bl_description, or a name or description of a property, or an icon."""
    if isinstance(node, ast.keyword):
        return node.arg in {"description", "name", "icon"}
    return isinstance(node, ast.Assign) and _name_of(node).startswith("bl_")


def _text_arguments(call: ast.Call) -> Iterator[ast.expr]:
    yield from (keyword.value for keyword in call.keywords if keyword.arg == "text")
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
    elif isinstance(node, ast.JoinedStr | ast.Constant):
        yield OTHER_SENTENCE.sub("", _text(node))


def _name_of(node: ast.AST) -> str:
    if isinstance(node, ast.ClassDef | ast.FunctionDef):
        return node.name
    targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    names = targets[0].elts if isinstance(targets[0], ast.Tuple) else targets
    return next((each.id for each in names if isinstance(each, ast.Name)), "")


def _text(node: ast.Constant | ast.JoinedStr) -> str:
    """Return a text, with a named placeholder for each expression; empty for other values."""
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
    words = [word for _, word in WORDS.findall(ast.unparse(expression)) if word] or ["value"]
    clear = [word for word in words if word not in VAGUE] or words
    name = clear[-1].strip("_")
    n_before = sum(each.rstrip("0123456789") == name for each in used)
    return f"{name}{n_before + 1}" if n_before else name


def _can_be_recognized(text: str) -> bool:
    """Whether a text is of the window and is found again once its placeholders are filled."""
    literal = "".join(part for part, *_ in Formatter().parse(text))
    if ARRAYS.search(literal):
        return False
    n_letters = sum(letter.isalpha() for letter in literal)
    return n_letters >= (MIN_LETTERS if "{" in text else 1)
