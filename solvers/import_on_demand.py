"""Let a package import its public names when they are first used, not all at its own import.

A command or a press needs a few of the modules below `solvers`; all of them take longer to
import than most commands take to run.
"""

import ast
import sys
from importlib import import_module
from inspect import getsource
from types import ModuleType
from typing import Any


class PackageOnDemand(ModuleType):
    """A package whose public names are imported when they are first used."""

    def __getattr__(self, name: str) -> Any:
        home = self.__dict__["_homes"].get(name)
        if home is None:
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        try:
            value = getattr(import_module(home, self.__name__), name)
        except AttributeError as error:  # `from package import name` would not show its cause
            raise ImportError(f"{self.__name__} cannot import {name!r}: {error}") from error
        setattr(self, name, value)
        return value

    def __setattr__(self, name: str, value: Any) -> None:
        """Set an attribute; for a module with the name of its public function, that function.

        Python sets each imported module as an attribute of its package.
        """
        is_own_module = (
            isinstance(value, ModuleType) and value.__name__ == f"{self.__name__}.{name}"
        )
        if is_own_module and name in self.__dict__["_homes"]:
            value = getattr(value, name)
        super().__setattr__(name, value)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.__dict__["_homes"]})


def import_on_demand(package: str) -> None:
    """Import what a package's block `if TYPE_CHECKING:` imports, each name on first use.

    Type checkers and readers see ordinary imports there, as in SPEC 1 of Scientific Python
    [1]_. Nothing changes for users of the package: `from solvers.denoising import denoise`
    imports what `denoise` needs. A package that is reloaded imports its names again.

    Parameters
    ----------
    package : str
        The `__name__` of the package; the caller is its `__init__`, at the end.

    References
    ----------
    .. [1] SPEC 1, Lazy loading of submodules and functions.
       https://scientific-python.org/specs/spec-0001/
    """
    module = sys.modules[package]
    imports = [
        each
        for block in ast.parse(getsource(module)).body
        if isinstance(block, ast.If) and ast.unparse(block.test) == "TYPE_CHECKING"
        for each in block.body
    ]
    homes = {
        alias.name: "." * each.level + (each.module or "")
        for each in imports
        if isinstance(each, ast.ImportFrom)
        for alias in each.names
    }
    for name in homes:
        module.__dict__.pop(name, None)
    module.__dict__["_homes"] = homes
    module.__class__ = PackageOnDemand
