"""`python -m solvers VERB ...`: see `python -m solvers --help`."""

import os
import sys

from .processes import thread_environment, threads_of_words


def main() -> int:
    """Run the command line with its number of linear algebra threads, by default one.

    NumPy reads this number on import, so it must not be imported before.
    """
    words = sys.argv[1:]
    os.environ.update(thread_environment(threads_of_words(words)))
    from .command_line.run import run
    from .command_line.verbs import VERBS

    return run(VERBS, words, "python -m solvers")


if __name__ == "__main__":
    sys.exit(main())
