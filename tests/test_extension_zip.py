"""What an animator installs: all that is needed, nothing that is not, and no bad manners."""

import ast
import re
import subprocess
import sys
import tomllib
from importlib.util import find_spec
from pathlib import Path
from zipfile import ZipFile

import pytest

ROOT = Path(__file__).parents[1]
SHIPPED = {
    "blender_manifest.toml",
    "__init__.py",
    "LICENSE",
    "README.md",
    "CHANGELOG.md",
    "SECURITY.md",
    "solvers",
    "mocap_assist",
    "operators",
}
OURS = {"solvers", "mocap_assist", "operators"}
# What Blender brings itself, and the import names of our wheels where they differ.
BLENDER = {
    "bpy",
    "bpy_extras",
    "mathutils",
    "bmesh",
    "gpu",
    "gpu_extras",
    "blf",
    "addon_utils",
    "rna_keymap_ui",
}
BUNDLED = BLENDER | {"bl_ui", "numpy"}
IMPORT_NAMES = {"pillow": "PIL"}
ON_LOOPBACK = {"receiver.py", "replay_verb.py"}
NETWORK = {"urllib", "http", "socket", "requests", "ftplib"}


@pytest.fixture(scope="module")
def shipped(tmp_path_factory) -> ZipFile:
    """A zip without wheels, built from this checkout by Blender's own tool."""
    if find_spec("bpy") is None:
        pytest.skip("no bpy, which carries the tool that builds extensions")
    folder = tmp_path_factory.mktemp("zip")
    script = ROOT / ".ci" / "build_extension.py"
    command = [sys.executable, str(script), "--plain", "--output", str(folder)]
    built = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60)
    with ZipFile(built.stdout.strip()) as archive:
        yield archive


def test_zip_has_the_shipped_files_only(shipped):
    found = {name.split("/")[0] for name in shipped.namelist()}

    assert found <= SHIPPED
    assert found >= {"blender_manifest.toml", "__init__.py", "LICENSE"} | OURS


def test_zip_has_no_temporary_files(shipped):
    litter = ("__pycache__", ".pyc", ".blend1", ".DS_Store", "~")

    assert not [name for name in shipped.namelist() if any(bad in name for bad in litter)]


def test_zip_has_every_module(shipped):
    for package in OURS:
        ours = {path.relative_to(ROOT).as_posix() for path in (ROOT / package).rglob("*.py")}
        assert ours <= set(shipped.namelist())


def test_every_folder_of_modules_is_a_package(shipped):
    names = set(shipped.namelist())
    folders = {name.rpartition("/")[0] for name in names if name.endswith(".py")} - {""}

    assert {f"{folder}/__init__.py" for folder in folders} <= names


def test_zip_version_equals_the_manifest(shipped):
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    inside = tomllib.loads(shipped.read("blender_manifest.toml").decode())

    assert inside["version"] == manifest["version"]
    assert f"mocap_assist-{manifest['version']}-" in Path(shipped.filename).name


def test_zip_imports_only_blender_and_wheels(shipped):
    """Otherwise it works on the developer's machine alone."""
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    wheels = {Path(wheel).name.split("-")[0] for wheel in manifest["wheels"]}
    allowed = (
        sys.stdlib_module_names | BUNDLED | {IMPORT_NAMES.get(name, name) for name in wheels}
    )

    for name, tree in modules(shipped):
        assert absolute_imports(tree) <= allowed, (
            f"{name} imports a library that is not shipped"
        )


def test_sockets_are_on_loopback_only_and_in_the_manifest(shipped):
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    assert "this machine" in manifest["permissions"]["network"]
    for name, tree in modules(shipped):
        if Path(name).name in ON_LOOPBACK:
            calls = [
                ast.unparse(node.args[-1])
                for node in ast.walk(tree)
                if isinstance(node, ast.Call)
                and isinstance(node.func, ast.Attribute)
                and node.func.attr in {"bind", "connect", "sendto"}
            ]
            assert calls, name
            assert all(call.startswith("(LOOPBACK, ") for call in calls), (name, calls)


def test_zip_does_not_change_the_import_path_or_use_the_network(shipped):
    """Both are against the rules of Blender's extensions platform; the live stream of joints
    stays on the machine, and the manifest says so."""
    for name, tree in modules(shipped):
        used = absolute_imports(tree) & NETWORK
        assert used <= ({"socket"} if Path(name).name in ON_LOOPBACK else set()), name
        changed = re.search(r"sys\.path\s*(\.|\[|\+?=)", shipped.read(name).decode())
        assert not changed, f"{name} changes the import path"


def modules(archive: ZipFile) -> list[tuple[str, ast.Module]]:
    """Name and syntax tree of each Python file in the zip."""
    names = [name for name in archive.namelist() if name.endswith(".py")]
    return [(name, ast.parse(archive.read(name), name)) for name in names]


def absolute_imports(tree: ast.Module) -> set[str]:
    """The top-level names that a module imports, wherever the statements stand."""
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level:
            names.add(node.module)
    return {name.split(".")[0] for name in names}
