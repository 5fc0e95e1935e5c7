"""`python -m solvers VERB ...`: see `python -m solvers --help`."""

import os
import sys

from .processes import thread_environment, threads_of_words


def main() -> int:
    """Solve with as many threads of linear algebra as the command line says, by default one.

    NumPy reads their number when it is imported, and so must not have been before.
    """
    words = sys.argv[1:]
    os.environ.update(thread_environment(threads_of_words(words)))
    from .command_line.run import run
    from .command_line.verbs import VERBS

    return run(VERBS, words, "python -m solvers")


if __name__ == "__main__":
    sys.exit(main())
