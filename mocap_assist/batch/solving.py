"""How commands solve: always in a process of its own, and with how many threads."""

import argparse
from collections.abc import Callable
from typing import TypeVar

from ...solvers.processes import threads_from
from ...solvers.progress import Progress
from ..jobs.job import run_apart

Result = TypeVar("Result")


def solve_in_subprocess(
    solve: Callable[..., Result], arguments: argparse.Namespace, progress: Progress
) -> Result:
    """Solve in another process, even what a button solves in Blender's own.

    There linear algebra has as many threads as the command line says, by default one; here it
    has those that Blender's environment gave it, and the last digits depend on them.
    """
    return run_apart(solve, progress, n_threads=threads_from(arguments))
