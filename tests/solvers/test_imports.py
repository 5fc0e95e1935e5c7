"""A command and a button import the solvers first: what they do not need must wait."""

import importlib
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import ModuleType

import pytest

import solvers
from solvers.command_line.verbs import VERBS

SLOW = (
    "scipy.cluster", "scipy.fft", "scipy.interpolate", "scipy.linalg", "scipy.ndimage",
    "scipy.optimize", "scipy.signal", "scipy.sparse", "scipy.spatial", "scipy.stats",
    "mujoco", "PIL", "matplotlib", "sklearn",
)  # fmt: skip
"""What Blender would load at its start, since it registers the settings of all verbs."""
FAMILIES = {
    "denoising", "depth_tracking", "feet", "gestures", "markers", "motion_fitting", "physics",
    "pictures", "reconstruction", "retargeting", "retrieval", "samples", "variation",
}  # fmt: skip
NEEDED = {
    "fix": {
        "denoising", "depth_tracking", "feet", "markers", "motion_fitting", "physics",
        "reconstruction",
    },
    "denoise": {"denoising", "feet", "markers", "motion_fitting"},
    "learn": {"denoising"},
    "quality": {"denoising", "feet", "motion_fitting"},
    "solve": {"denoising", "feet", "markers"},
    "capture": {"denoising", "depth_tracking", "feet", "motion_fitting"},
    "reconstruct": {"denoising", "feet", "motion_fitting", "reconstruction"},
    "learn-residuals": {"motion_fitting", "reconstruction"},
    "learn-postures": {"motion_fitting", "reconstruction"},
    "simulate": {"feet", "motion_fitting", "physics"},
    "index": {"retrieval"},
    "find": {"retrieval"},
    "vary": {"denoising", "feet", "motion_fitting", "pictures", "variation"},
    "convert": set(),
    "retarget": {"feet", "motion_fitting", "retargeting"},
    "replay": set(),
    "report": {"pictures"},
    "unbake": {"feet", "motion_fitting", "retargeting"},
}  # fmt: skip
"""The families that each verb of the command line may import before its work begins."""
WITHOUT_SCIPY = {"convert", "replay", "report"}
IMPORT_EACH = """
import os, sys
from solvers.command_line.verbs import VERBS
for name, verb in VERBS.items():
    sys.stdout.flush()
    if os.fork() == 0:
        verb.work()
        print(name, *sys.modules, flush=True)
        os._exit(0)
    os.wait()
"""


def imported(code: str, *arguments: str) -> str:
    run = subprocess.run(
        [sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=True
    )
    return run.stdout


@pytest.fixture(scope="module")
def imported_by_verb() -> dict[str, set[str]]:
    lines = [line.split() for line in imported(IMPORT_EACH).splitlines()]
    return {name: set(modules) for name, *modules in lines}


@pytest.mark.parametrize("verb", VERBS)
def test_a_verb_imports_only_its_families(verb, imported_by_verb):
    modules = imported_by_verb[verb]

    assert {name for name in FAMILIES if f"solvers.{name}" in modules} <= NEEDED[verb]
    assert ("scipy" in modules) <= (verb not in WITHOUT_SCIPY)
    assert modules.isdisjoint(SLOW)


def test_help_imports_no_family_and_no_scipy():
    code = """
import sys
from solvers.command_line.run import run
from solvers.command_line.verbs import VERBS
try:
    run(VERBS, ["--help"], "solvers")
except SystemExit:
    print("MODULES", *sys.modules)
"""
    modules = set(imported(code).partition("MODULES")[2].split())

    assert "solvers.command_line.run" in modules
    assert modules.isdisjoint({"scipy", *SLOW, *(f"solvers.{name}" for name in FAMILIES)})


def test_slow_libraries_are_imported_on_demand():
    code = """
import sys
from importlib import import_module
for package in map(import_module, sys.argv[1:]):
    for name in package.__all__:
        getattr(package, name)
print(*sys.modules)
"""
    modules = set(imported(code, *ON_DEMAND).split())

    assert "scipy" in modules and modules.isdisjoint(SLOW)


def test_reading_needs_no_scipy():
    """A background Blender reads files of other programs: its start is what they wait for."""
    code = "import sys; from solvers.recordings import read_recording; print(*sys.modules)"
    modules = set(imported(code).split())

    assert "solvers.recordings.read_recording" in modules
    assert "scipy" not in modules


ROOT = Path(solvers.__file__).parent
ON_DEMAND = [
    ".".join(file.parent.relative_to(ROOT.parent).parts)
    for file in sorted(ROOT.rglob("__init__.py"))
    if "import_on_demand(__name__)" in file.read_text(encoding="utf-8")
]
INIT = """
from typing import TYPE_CHECKING
from solvers.import_on_demand import import_on_demand
if TYPE_CHECKING:
    from .work import Work
    from .check import check
__all__ = ["Work", "check"]
import_on_demand(__name__)
"""


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package on demand with a class `Work`, whose module the test may write again."""
    folder = tmp_path / "lazy_package"
    folder.mkdir()
    (folder / "__init__.py").write_text(INIT)
    (folder / "work.py").write_text("class Work: pass")
    (folder / "check.py").write_text("def check(): pass")
    monkeypatch.syspath_prepend(tmp_path)
    yield folder
    for name in [name for name in sys.modules if name.split(".")[0] == "lazy_package"]:
        del sys.modules[name]


@pytest.mark.parametrize("name", ON_DEMAND)
def test_all_public_names_of_a_package_can_be_used(name):
    found = importlib.import_module(name)

    assert set(found.__all__) <= set(dir(found))
    for public in found.__all__:
        assert not isinstance(getattr(found, public), ModuleType)
    with pytest.raises(AttributeError, match="has no attribute 'denois'"):
        _ = found.denois


def test_fault_of_a_module_is_shown_where_a_name_of_it_is_imported(package):
    (package / "work.py").write_text("import math\nmath.no_such_function")

    with pytest.raises(ImportError, match="no attribute 'no_such_function'"):
        from lazy_package import Work  # noqa: F401


@pytest.mark.filterwarnings("ignore:Cannot set an attribute:ImportWarning")
def test_name_without_a_definition_is_not_its_module(package):
    """Python takes the module of that name where an attribute is missing."""
    (package / "check.py").write_text("")

    with pytest.raises(ImportError, match="lazy_package cannot import 'check'"):
        from lazy_package import check  # noqa: F401


def test_reloaded_package_has_the_new_names(package):
    found = importlib.import_module("lazy_package")
    former = found.Work, found.check
    for name in ("lazy_package.work", "lazy_package.check"):
        del sys.modules[name]

    importlib.reload(found)

    assert found.Work is not former[0] and found.check is not former[1]


def test_star_imports_the_public_names(package):
    names = {}
    exec("from lazy_package import *", names)

    assert {"Work", "check"} == {name for name in names if not name.startswith("__")}
    assert not isinstance(names["check"], ModuleType)


def test_threads_that_use_a_name_first_get_one_object(package):
    (package / "work.py").write_text("import time\ntime.sleep(0.05)\nclass Work: pass")
    found = importlib.import_module("lazy_package")

    with ThreadPoolExecutor(8) as threads:
        classes = set(threads.map(lambda _: found.Work, range(8)))

    assert len(classes) == 1


def test_a_function_is_found_where_its_module_has_the_same_name():
    """Python sets a module as an attribute of its package once it is imported."""
    code = """
import solvers.feet.plant_feet
from solvers.feet import plant_feet
print(type(plant_feet).__name__, type(solvers.feet.plant_feet).__name__)
"""
    assert imported(code).split() == ["function", "function"]
