"""`python -m solvers VERB ...`: see `python -m solvers --help`."""

import sys

from .command_line.run import run
from .command_line.verbs import VERBS

if __name__ == "__main__":
    sys.exit(run(VERBS, sys.argv[1:], "python -m solvers"))
