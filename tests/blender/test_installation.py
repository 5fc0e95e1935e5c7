"""The zip must install into a bare Blender, bring its libraries, and break no policy."""

import importlib
import subprocess
import sys
from pathlib import Path

import addon_utils
import pytest


def test_extension_is_enabled_at_startup(extension):
    assert addon_utils.check(extension.__name__) == (True, True)


def test_extension_violates_no_policy(extension):
    assert not addon_utils._extensions_warnings_get()


@pytest.mark.parametrize("name", ["scipy", "PIL"])
def test_libraries_come_from_the_wheels(name, extension):
    library = Path(importlib.import_module(name).__file__)

    assert library.is_relative_to(Path(extension.__file__).parents[2] / ".local"), library


def test_start_of_blender_loads_no_library_that_a_press_needs(extension):
    """They and the commands are a third of the time that the extension needs to start."""
    code = f"""
import os, sys, bpy, addon_utils
addon_utils.enable("{extension.__name__}")
print("MODULES", *sys.modules, flush=True)
os._exit(0)
"""
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    modules = set(run.stdout.partition("MODULES")[2].split())

    assert f"{extension.__name__}.operators.denoise" in modules
    late = {"scipy.linalg", "scipy.ndimage", "scipy.spatial", "scipy.special", "asyncio"}
    assert modules.isdisjoint({*late, f"{extension.__name__}.mocap_assist.batch.command"})


def test_every_module_imports(extension, load):
    root = Path(extension.__file__).parent
    modules = [path.relative_to(root).with_suffix("") for path in sorted(root.rglob("*.py"))]

    for module in modules:
        if module.name not in {"__init__", "__main__"}:
            load(".".join(module.parts))


def test_extension_can_be_disabled_and_enabled(extension, blank):
    addon_utils.disable(extension.__name__)
    assert addon_utils.check(extension.__name__) == (True, False)

    addon_utils.enable(extension.__name__)
    assert addon_utils.check(extension.__name__) == (True, True)
