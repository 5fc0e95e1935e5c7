"""A command and a button import the solvers first: what they do not need must wait."""

import subprocess
import sys

import pytest

import solvers.denoising
import solvers.feet
import solvers.recordings
from solvers.command_line.verbs import VERBS

SLOW = ("scipy.signal", "scipy.stats", "mujoco", "PIL", "matplotlib", "sklearn")
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
    "solve": {"denoising", "markers"},
    "capture": {"denoising", "depth_tracking", "feet", "motion_fitting"},
    "reconstruct": {"denoising", "feet", "motion_fitting", "reconstruction"},
    "learn-residuals": {"motion_fitting", "reconstruction"},
    "learn-postures": {"motion_fitting", "reconstruction"},
    "simulate": {"motion_fitting", "physics"},
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


def imported(code: str) -> str:
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
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
import sys, solvers.workflows as workflows
for name in workflows.__all__:
    getattr(workflows, name)
print(*sys.modules)
"""
    assert set(imported(code).split()).isdisjoint(SLOW)


def test_reading_needs_no_scipy():
    """A background Blender reads files of other programs: its start is what they wait for."""
    code = "import sys; from solvers.recordings import read_recording; print(*sys.modules)"
    modules = set(imported(code).split())

    assert "solvers.recordings.read_recording" in modules
    assert "scipy" not in modules


@pytest.mark.parametrize("package", [solvers.denoising, solvers.feet, solvers.recordings])
def test_all_public_names_of_a_package_can_be_used(package):
    assert set(package.__all__) <= set(dir(package))
    for name in package.__all__:
        assert getattr(package, name) is not None
    with pytest.raises(AttributeError, match="has no attribute 'denois'"):
        _ = package.denois


def test_a_function_is_found_where_its_module_has_the_same_name():
    """Python sets a module as an attribute of its package once it is imported."""
    code = """
import solvers.feet.plant_feet
from solvers.feet import plant_feet
print(type(plant_feet).__name__, type(solvers.feet.plant_feet).__name__)
"""
    assert imported(code).split() == ["function", "function"]
