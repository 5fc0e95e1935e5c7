"""What an animator installs: all that is needed, nothing that is not, and no bad manners."""

import ast
import posixpath
import re
import subprocess
import sys
import tomllib
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from zipfile import ZipFile

import build_extension
import pytest

ROOT = Path(__file__).parents[1]
SHIPPED = {
    "blender_manifest.toml",
    "__init__.py",
    "LICENSE",
    "NOTICE.md",
    "README.md",
    "CHANGELOG.md",
    "SECURITY.md",
    "solvers",
    "mocap_assist",
    "operators",
}
TEXTS = {
    "", ".css", ".html", ".jpg", ".js", ".md", ".png", ".po", ".py", ".sh", ".toml", ".typed",
    ".yaml",
}  # fmt: skip
"""Endings of files that people write or draw; all others hold learned numbers."""
MAX_MANUAL_BYTES = 2_000_000
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
BUNDLED = BLENDER | {"bl_operators", "bl_ui", "numpy", "pxr"}
IMPORT_NAMES = {"pillow": "PIL"}
OPTIONAL = {"cluster.py": {"dask", "distributed"}}
"""What a module imports where it is installed, and reports as missing elsewhere."""
ON_LOOPBACK = {"receiver.py", "replay_verb.py"}
ADDRESSES = {"receiver.py": {"(LOOPBACK", "(ALL_ADDRESSES"}, "replay_verb.py": {"(LOOPBACK"}}
"""What they bind or connect to; all addresses only for a list of allowed ones."""
NETWORK = {"urllib", "http", "socket", "requests", "ftplib"}
OVER_HTTP = "flamenco_manager.py"
"""The module that submits a job when the user says so, to the address that the user entered."""


@pytest.fixture(scope="module")
def shipped(tmp_path_factory) -> ZipFile:
    """A zip without wheels, built from this checkout by Blender's own tool."""
    if find_spec("bpy") is None:
        pytest.skip("no bpy, which carries the tool that builds extensions")
    folder = tmp_path_factory.mktemp("zip")
    script = ROOT / ".ci" / "packages" / "build_extension.py"
    command = [sys.executable, str(script), "--plain", "--output", str(folder)]
    built = subprocess.run(command, capture_output=True, text=True, check=True, timeout=500)
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


def test_notice_names_every_learned_file_and_library(shipped):
    notice = shipped.read("NOTICE.md").decode()
    rows = dict(re.findall(r"^\| `(\S+)` \| `(\S+)` \|", notice, re.MULTILINE))
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    libraries = {Path(wheel).name.split("-")[0] for wheel in manifest["wheels"]}

    assert set(rows) == {name for name in shipped.namelist() if Path(name).suffix not in TEXTS}
    assert all((ROOT / "tests" / "training" / script).is_file() for script in rows.values())
    assert libraries == set(re.findall(r"^\| (\w+) \|", notice.lower(), re.MULTILINE)) - {
        "file", "library",
    }  # fmt: skip


def test_notice_names_every_module_with_learned_numbers():
    notice = (ROOT / "NOTICE.md").read_text(encoding="utf-8")
    named = dict(re.findall(r"^- `(\S+)`: `(\S+)`", notice, re.MULTILINE))
    scripts = {
        path.relative_to(ROOT).as_posix(): Path(found[1]).stem
        for path in (ROOT / "solvers").rglob("*.py")
        if (found := re.search(r"Learned by\s+`(\S+?)[` ]", path.read_text(encoding="utf-8")))
    }

    assert scripts
    assert {name: Path(script).stem for name, script in named.items()} == scripts


def test_zip_has_a_small_manual_whose_links_lead_somewhere(shipped):
    root = f"{build_extension.PAGES.as_posix()}/"
    names = {name for name in shipped.namelist() if name.startswith(root)}
    pages = {name: shipped.read(name).decode("utf-8") for name in names if ".html" in name}

    assert f"{root}README.html" in pages
    assert sum(shipped.getinfo(name).compress_size for name in names) < MAX_MANUAL_BYTES
    for name, page in pages.items():
        for link in re.findall(r'(?:href|src)="([^":]+)"', page):
            path, _, anchor = link.partition("#")
            target = posixpath.normpath(posixpath.join(posixpath.dirname(name), path))
            target = target if path else name
            assert target in shipped.namelist(), (name, link)
            if anchor:
                assert f'id="{anchor}"' in pages[target], (name, link)


@pytest.mark.parametrize("python", ["3.11", "3.13"])
def test_zip_for_one_python_has_its_wheels_and_blenders(python):
    text = (ROOT / "blender_manifest.toml").read_text(encoding="utf-8")
    both = tomllib.loads(text)
    wheels = [build_extension.Wheel.from_path(wheel) for wheel in both["wheels"]]
    chosen = [wheel for wheel in wheels if wheel.fits(python) and wheel.serves("linux-x64")]

    restricted = build_extension.restricted(text, ["linux-x64"], chosen, python)

    manifest = tomllib.loads(restricted)
    tag = f"-cp{python.replace('.', '')}-"
    assert len(manifest["wheels"]) == 4
    assert all(tag in wheel or "-py3-" in wheel for wheel in manifest["wheels"])
    assert all("manylinux" in wheel or "-py3-" in wheel for wheel in manifest["wheels"])
    blenders = manifest["blender_version_min"], manifest.get("blender_version_max")
    assert blenders == {"3.11": ("4.5.0", "5.1.0"), "3.13": ("5.1.0", None)}[python]
    changed = ("platforms", "wheels", "blender_version_min", "blender_version_max")
    for kept in (manifest, both):
        for key in changed:
            kept.pop(key, None)
    assert manifest == both


def test_zip_imports_only_blender_and_wheels(shipped):
    """Otherwise it works on the developer's machine alone."""
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    wheels = {Path(wheel).name.split("-")[0] for wheel in manifest["wheels"]}
    allowed = (
        sys.stdlib_module_names | BUNDLED | {IMPORT_NAMES.get(name, name) for name in wheels}
    )

    for name, tree in modules(shipped):
        optional = OPTIONAL.get(Path(name).name, set())
        assert absolute_imports(tree) <= allowed | optional, (
            f"{name} imports a library that is not shipped"
        )


def test_sockets_are_on_loopback_only_and_in_the_manifest(shipped):
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    assert "this machine" in manifest["permissions"]["network"]
    assert "farm" in manifest["permissions"]["network"]
    for name, tree in modules(shipped):
        if (file := Path(name).name) in ON_LOOPBACK:
            calls = [
                ast.unparse(node.args[-1])
                for node in ast.walk(tree)
                if isinstance(node, ast.Call)
                and isinstance(node.func, ast.Attribute)
                and node.func.attr in {"bind", "connect", "sendto"}
            ]
            assert calls, name
            assert {call.split(",")[0] for call in calls} <= ADDRESSES[file], (name, calls)


def test_zip_does_not_change_the_import_path_or_use_the_network(shipped):
    """Both are against the rules of Blender's extensions platform, but for what the manifest
    names: the live stream of joints, and jobs for a farm."""
    for name, tree in modules(shipped):
        file, used = Path(name).name, absolute_imports(tree) & NETWORK
        allowed = {"urllib", "http"} if file == OVER_HTTP else set()
        assert used <= ({"socket"} if file in ON_LOOPBACK else allowed), name
        changed = re.search(r"sys\.path\s*(\.|\[|\+?=)", shipped.read(name).decode())
        assert not changed, f"{name} changes the import path"


@cache
def modules(archive: ZipFile) -> list[tuple[str, ast.Module]]:
    """Name and syntax tree of each Python file in the zip."""
    names = [name for name in archive.namelist() if name.endswith(".py")]
    return [(name, ast.parse(archive.read(name), name)) for name in names]


@cache
def absolute_imports(tree: ast.Module) -> set[str]:
    """The top-level names that a module imports, wherever the statements stand."""
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level:
            names.add(node.module)
    return {name.split(".")[0] for name in names}
