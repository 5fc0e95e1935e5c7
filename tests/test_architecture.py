"""The folder layout is a promise about who may know whom; this keeps the promise."""

import ast
from collections import Counter
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
BLENDER = {"bpy", "bpy_extras", "mathutils", "bmesh", "gpu", "gpu_extras", "blf"}
MAY_IMPORT = {
    "solvers": set(),
    "mocap_assist": {"solvers"},
    "operators": {"mocap_assist", "solvers"},
}
COMMON_PACKAGES = {
    "archives", "arrays", "depth_scene", "errors", "faults", "feet", "files",
    "import_on_demand", "json_text", "motion", "motion_fitting", "npz_members", "progress",
    "rotations", "settings", "signals",
}  # fmt: skip
FAMILIES = [
    folder.name
    for folder in sorted((ROOT / "solvers").iterdir())
    if folder.is_dir() and folder.name not in {"__pycache__", "workflows", "command_line"}
]
MAX_FILE_LINES = 300
MAX_FOLDER_FILES = 24


def modules(path: str) -> list[Path]:
    return sorted((ROOT / path).rglob("*.py"))


@cache
def nodes(module: Path) -> list[ast.Import | ast.ImportFrom | ast.ClassDef]:
    """The imports and classes of a module, wherever they stand."""
    tree = ast.parse(module.read_text(encoding="utf-8"))
    kinds = ast.Import, ast.ImportFrom, ast.ClassDef
    return [node for node in ast.walk(tree) if isinstance(node, kinds)]


def imports(module: Path) -> set[tuple[int, str]]:
    """(number of leading dots, first name) of each import statement."""
    found = set()
    for node in nodes(module):
        if isinstance(node, ast.Import):
            found |= {(0, alias.name.split(".")[0]) for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names = [node.module] if node.module else [alias.name for alias in node.names]
            found |= {(node.level, name.split(".")[0]) for name in names}
    return found


@cache
def imported_paths(module: Path) -> set[Path]:
    """Modules and packages of ours that a module imports from, as paths without a suffix."""
    found = set()
    for node in nodes(module):
        if not isinstance(node, ast.ImportFrom) or not node.level:
            continue
        target = module.parents[node.level - 1].joinpath(*(node.module or "").split("."))
        for alias in node.names:
            inner = target / alias.name
            is_module = not node.module and inner.with_suffix(".py").exists()
            found.add(inner if is_module or inner.is_dir() else target)
    return found


def folder(path: Path) -> Path:
    """Return the folder of what was imported; the few modules at the top are on their own."""
    home = path if path.is_dir() else path.parent
    return path if home.parent == ROOT else home


def test_solvers_are_free_of_blender():
    for module in modules("solvers"):
        assert not {name for _, name in imports(module)} & BLENDER, module


def test_modules_of_a_job_are_free_of_blender():
    """A solve runs in a bare Python; so do all modules that one of them imports."""
    jobs = [*modules("mocap_assist/jobs"), *(ROOT / "mocap_assist").rglob("solve_*.py")]
    visited = set[Path]()
    while jobs:
        module = jobs.pop()
        if module in visited:
            continue
        visited.add(module)
        assert not {name for _, name in imports(module)} & BLENDER, module
        inner = (path.with_suffix(".py") for path in imported_paths(module))
        jobs += [path for path in inner if path.exists() and "mocap_assist" in path.parts]


@pytest.mark.parametrize("layer", MAY_IMPORT)
def test_layers_import_only_lower_layers(layer):
    for module in modules(layer):
        depth = len(module.relative_to(ROOT).parts)
        above = {name for dots, name in imports(module) if dots == depth}
        assert above <= MAY_IMPORT[layer], module
        absolute = {name for dots, name in imports(module) if dots == 0}
        assert not absolute & set(MAY_IMPORT), f"{module} imports its own project absolutely"


@pytest.mark.parametrize("family", FAMILIES)
def test_families_import_only_common_packages(family):
    for module in modules(f"solvers/{family}"):
        depth = len(module.relative_to(ROOT / "solvers").parts)
        above = {name for dots, name in imports(module) if dots == depth}
        assert above <= COMMON_PACKAGES, module


def test_packages_of_solvers_are_imported_by_their_init():
    """From outside, names come from a package's `__init__`, not from a module in it."""
    for module in [each for layer in MAY_IMPORT for each in modules(layer)]:
        for path in imported_paths(module):
            inside = path.is_relative_to(ROOT / "solvers") and not path.is_dir()
            faceless = {ROOT / "solvers", ROOT / "solvers" / "command_line", module.parent}
            if inside and path.parent not in faceless:
                raise AssertionError(f"{module} imports from {path.relative_to(ROOT)}.py")


def imported_folders(layer: str) -> dict[Path, set[Path]]:
    """Return for each folder of a layer those that its modules import from."""
    graph = dict[Path, set[Path]]()
    for module in modules(layer):
        if module.name != "__init__.py":
            home = folder(module)
            targets = {folder(path) for path in imported_paths(module)}
            graph[home] = graph.get(home, set()) | targets - {home}
    return graph


def import_cycle(graph: dict[Path, set[Path]]) -> list[Path]:
    """Return folders that import each other in a ring of any length, or an empty list."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return error.args[1]
    return []


@pytest.mark.parametrize("layer", ["solvers", "mocap_assist"])
def test_no_folders_import_each_other_in_a_ring(layer):
    assert not import_cycle(imported_folders(layer))


def test_rings_of_three_folders_are_found():
    first, second, third = Path("a"), Path("b"), Path("c")
    graph = {first: {second}, second: {third}}

    assert not import_cycle(graph)
    assert set(import_cycle(graph | {third: {first}})) == {first, second, third}


@pytest.mark.parametrize("layer", ["solvers", "mocap_assist", "tests", "docs", ".ci"])
def test_no_folder_holds_too_many_files(layer):
    """Counted are modules, and the pages and pictures of the documents."""
    files = (ROOT / layer).rglob("*.*" if layer == "docs" else "*.py")
    for home, n_files in Counter(file.parent for file in files if file.is_file()).items():
        assert n_files <= MAX_FOLDER_FILES, f"{home} has {n_files} files"


def test_no_file_is_longer_than_the_limit():
    for layer in (*MAY_IMPORT, "tests"):
        for module in modules(layer):
            n_lines = len(module.read_text(encoding="utf-8").splitlines())
            assert n_lines <= MAX_FILE_LINES, f"{module} has {n_lines} lines"


def test_each_class_has_a_name_of_its_own():
    """Also a private one: a name read in one module must not mean another thing in the next."""
    names = Counter(
        node.name
        for layer in MAY_IMPORT
        for module in modules(layer)
        for node in nodes(module)
        if isinstance(node, ast.ClassDef)
    )

    assert not [name for name, count in names.items() if count > 1]


def test_no_module_is_called_as_another_next_to_it_with_an_s():
    """`operators` aside: there a button for one take and one for several are both right."""
    for module in [*modules("solvers"), *modules("mocap_assist")]:
        assert not module.with_name(f"{module.stem}s.py").exists(), module


def test_foreign_json_is_parsed_by_one_function():
    """`parse_json` refuses what is nested too deeply."""
    for layer in MAY_IMPORT:
        for module in modules(layer):
            text = module.read_text(encoding="utf-8")
            assert module.name == "json_text.py" or "json.load" not in text, module
