"""The zip must install into a bare Blender, bring its libraries, and break no policy."""

import importlib
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
