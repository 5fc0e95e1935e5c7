"""Solve in a subprocess, with the number of threads of the command line."""

import argparse
from collections.abc import Callable
from typing import TypeVar

from ...solvers.processes import threads_from
from ...solvers.progress import Progress
from ..jobs.job import run_in_subprocess

Result = TypeVar("Result")


def solve_in_subprocess(
    solve: Callable[..., Result], arguments: argparse.Namespace, progress: Progress
) -> Result:
    """Solve in a subprocess, even a solve that a button runs in Blender's process.

    The subprocess uses the number of threads from the command line, by default one. Blender's
    process uses that of its environment, which changes the last digits.
    """
    return run_in_subprocess(solve, progress, n_threads=threads_from(arguments))
