"""Number of threads of linear algebra: one, so that the bytes are the same everywhere.

On matrices of this size two threads took thirty times as long, and they round sums in another
order. NumPy and SciPy read these variables once, when they are imported.
"""

import argparse
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

VARIABLES = (
    "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS",
    "BLIS_NUM_THREADS", "NUMEXPR_NUM_THREADS",
)  # fmt: skip
OPTION = "--threads"


def thread_environment(n_threads: int = 1) -> dict[str, str]:
    """Return the environment variables that set the number of threads of linear algebra."""
    return dict.fromkeys(VARIABLES, str(n_threads))


@contextmanager
def processes_with_threads(n_threads: int = 1) -> Iterator[None]:
    """Give processes that start meanwhile this number, whatever the environment says."""
    before = {name: os.environ.get(name) for name in VARIABLES}
    os.environ.update(thread_environment(n_threads))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def add_threads_option(parser: argparse.ArgumentParser) -> None:
    """Add `--threads`; without it the attribute is missing, see `threads_from`."""
    parser.add_argument(
        OPTION, type=_count, metavar="N", default=argparse.SUPPRESS,
        help="Threads of linear algebra in each process, regardless of environment variables;"
        " with more than one the last digits of results may differ [default 1]",
    )  # fmt: skip


def threads_from(arguments: argparse.Namespace) -> int:
    """Return the number of threads that the command line requests."""
    n_threads: int = getattr(arguments, OPTION.lstrip("-"), 1)
    return n_threads


def threads_from_arguments(words: Sequence[str]) -> int:
    """Return the number of threads that a command line requests, before it is parsed.

    An invalid number counts as one: the full parser, which imports numpy, reports it.
    """
    parser = argparse.ArgumentParser(add_help=False)
    parser.add_argument(OPTION, nargs="?", default="1")
    found = parser.parse_known_args(words)[0].threads or ""
    return max(int(found), 1) if found.isdecimal() else 1


def _count(word: str) -> int:
    count = int(word)
    if count < 1:
        raise argparse.ArgumentTypeError(f"{word} is too few; it must be at least 1")
    return count


_count.__name__ = "count"
