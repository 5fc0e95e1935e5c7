"""Run a metric with another value of one constant, in a process of its own.

The process that asks never imports a solver. A child imports the solvers afresh, and the one
module that is varied is compiled from a syntax tree in which the value of the constant is
replaced. So names that other modules imported, default arguments and the defaults of frozen
settings all see the other value.
"""

import ast
import importlib
import math
import multiprocessing
import pickle
import sys
import time
from dataclasses import dataclass, field
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from multiprocessing.connection import Connection
from typing import Any

from .constants import Constant, assigned_values

TIMEOUT_S = 90.0
FORK = multiprocessing.get_context("fork")


@dataclass(frozen=True)
class Outcome:
    """Figures by name, or why there are none."""

    figures: dict[str, float] = field(default_factory=dict)
    cpu_s: float = 0.0
    failure: str = ""


def prepare(family: str) -> bytes:
    """Return the inputs of a metric, made by the solvers as they are."""
    return _in_child(_prepare, (family,))


def evaluate(
    family: str, inputs: bytes, constant: Constant | None = None, value: Any = None
) -> Outcome:
    """Return the figures of a family's metric with another value of one constant."""
    outcome = _in_child(_measure, (family, inputs, constant, value))
    return outcome if isinstance(outcome, Outcome) else Outcome(failure=str(outcome))


def _in_child(task: Any, arguments: tuple[Any, ...]) -> Any:
    ours, theirs = FORK.Pipe(duplex=False)
    child = FORK.Process(target=_answer, args=(theirs, task, arguments))
    child.start()
    theirs.close()
    try:
        if ours.poll(TIMEOUT_S if task is _measure else None):
            return ours.recv()
        return f"takes more than {TIMEOUT_S:g} s"
    except EOFError:
        return "the process ended without an answer"
    finally:
        child.kill()
        child.join()


def _answer(connection: Connection, task: Any, arguments: tuple[Any, ...]) -> None:
    try:
        answer = task(*arguments)
    except Exception as error:
        if task is _prepare:
            raise
        answer = f"{type(error).__name__}: {' '.join(str(error).split())[:100]}"
    connection.send(answer)
    connection.close()


def _metric(family: str) -> Any:
    return importlib.import_module(f"{__package__}.metrics.{family}")


def _prepare(family: str) -> bytes:
    return pickle.dumps(_metric(family).prepare())


def _measure(family: str, inputs: bytes, constant: Constant | None, value: Any) -> Outcome:
    if constant is not None:
        replace_on_import(constant, value)
    metric = _metric(family)
    data = pickle.loads(inputs)
    started = time.process_time()
    figures = metric.measure(**data)
    if not all(math.isfinite(figure) for figure in figures.values()):
        return Outcome(failure="an error is not finite")
    return Outcome(dict(figures), time.process_time() - started)


def replace_on_import(constant: Constant, value: Any) -> None:
    """Give a constant another value in this process, which has not imported its module yet."""
    sys.meta_path.insert(0, _Replacing(constant, value))


class _Replacing(MetaPathFinder):
    """Finds the module of the constant, and has it compiled with the other value."""

    def __init__(self, constant: Constant, value: Any) -> None:
        self._constant, self._value = constant, value

    def find_spec(self, fullname: str, path: Any, target: Any = None) -> ModuleSpec | None:
        if fullname != self._constant.module:
            return None
        spec = PathFinder.find_spec(fullname, path, target)
        assert spec is not None and spec.origin is not None
        spec.loader = _ReplacingLoader(fullname, spec.origin, self._constant, self._value)
        return spec


class _ReplacingLoader(SourceFileLoader):
    def __init__(self, name: str, path: str, constant: Constant, value: Any) -> None:
        super().__init__(name, path)
        self._constant, self._value = constant, value

    def get_code(self, fullname: str) -> Any:
        tree = ast.parse(self.get_data(self.path))
        value = ast.parse(repr(self._value).replace("inf", "1e999"), mode="eval").body
        for node in tree.body:
            for name, expression in assigned_values(node).items():
                if name == self._constant.name:
                    _replace(node, expression, value)
        return compile(ast.fix_missing_locations(tree), self.path, "exec")


def _replace(node: ast.stmt, old: ast.expr, new: ast.expr) -> None:
    assert isinstance(node, ast.Assign | ast.AnnAssign)
    if node.value is old:
        node.value = new
    else:
        assert isinstance(node.value, ast.Tuple)
        node.value.elts = [new if each is old else each for each in node.value.elts]
