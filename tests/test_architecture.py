"""The folder layout is a promise about who may know whom; this keeps the promise."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
BLENDER = {"bpy", "bpy_extras", "mathutils", "bmesh", "gpu", "gpu_extras", "blf"}
MAY_IMPORT = {
    "solvers": set(),
    "mocap_assist": {"solvers"},
    "operators": {"mocap_assist", "solvers"},
}
SHARED_ROOMS = {
    "archives", "errors", "faults", "files", "json_text", "motion", "npz_members", "progress",
    "settings",
}  # fmt: skip
FAMILIES = [
    folder.name
    for folder in sorted((ROOT / "solvers").iterdir())
    if folder.is_dir() and folder.name not in {"__pycache__", "workflows", "command_line"}
]
LONGEST_FILE = 300


def modules(path: str) -> list[Path]:
    return sorted((ROOT / path).rglob("*.py"))


def imports(module: Path) -> set[tuple[int, str]]:
    """(number of leading dots, first name) of each import statement, wherever it stands."""
    found = set()
    for node in ast.walk(ast.parse(module.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {(0, alias.name.split(".")[0]) for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names = [node.module] if node.module else [alias.name for alias in node.names]
            found |= {(node.level, name.split(".")[0]) for name in names}
    return found


@pytest.mark.parametrize("path", ["solvers", "mocap_assist/jobs"])
def test_free_of_blender(path):
    for module in modules(path):
        assert not {name for _, name in imports(module)} & BLENDER, module


@pytest.mark.parametrize("layer", MAY_IMPORT)
def test_layers_only_look_down(layer):
    for module in modules(layer):
        depth = len(module.relative_to(ROOT).parts)
        above = {name for dots, name in imports(module) if dots == depth}
        assert above <= MAY_IMPORT[layer], module
        absolute = {name for dots, name in imports(module) if dots == 0}
        assert not absolute & set(MAY_IMPORT), f"{module} imports its own project absolutely"


@pytest.mark.parametrize("family", FAMILIES)
def test_families_meet_only_in_the_vocabulary(family):
    for module in modules(f"solvers/{family}"):
        depth = len(module.relative_to(ROOT / "solvers").parts)
        above = {name for dots, name in imports(module) if dots == depth}
        assert above <= SHARED_ROOMS, module


def test_no_file_is_too_long_to_read():
    for layer in (*MAY_IMPORT, "tests"):
        for module in modules(layer):
            n_lines = len(module.read_text(encoding="utf-8").splitlines())
            assert n_lines <= LONGEST_FILE, f"{module} has {n_lines} lines"


def test_files_of_others_are_opened_in_one_place():
    """`open_regular` does not wait for a pipe, and refuses devices."""
    for family in FAMILIES:
        for module in modules(f"solvers/{family}"):
            if family == "processes":
                continue
            for text in ('.open("rb")', "Path(path).open(", ".read_bytes()", ".read_text("):
                assert text not in module.read_text(encoding="utf-8"), module


def test_json_of_others_is_parsed_in_one_place():
    """`parse_json` refuses what is nested too deeply."""
    for layer in MAY_IMPORT:
        for module in modules(layer):
            text = module.read_text(encoding="utf-8")
            assert module.name == "json_text.py" or "json.load" not in text, module
