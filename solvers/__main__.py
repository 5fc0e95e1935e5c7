"""`python -m solvers VERB ...`: see `python -m solvers --help`."""

import os
import sys

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


def main() -> int:
    """Solve with one thread of linear algebra, unless the environment says otherwise.

    On matrices of this size two threads were seen to take thirty times as long. NumPy looks at
    the environment when it is imported, and so must not have been before.
    """
    for name in THREADS:
        os.environ.setdefault(name, "1")
    from .command_line.run import run
    from .command_line.verbs import VERBS

    return run(VERBS, sys.argv[1:], "python -m solvers")


if __name__ == "__main__":
    sys.exit(main())
