"""`python -m solvers VERB ...`: see `python -m solvers --help`.

From an installed wheel the same is `mocap-assist VERB ...`.
"""

import os
import sys

from .processes import thread_environment, threads_from_arguments


def console_script() -> int:
    """Run the command `mocap-assist` of the Python package."""
    return main("mocap-assist")


def main(prog: str = f"python -m {__package__}") -> int:
    """Run the command line with its number of linear algebra threads, by default one.

    NumPy reads this number on import, so it must not be imported before.

    Parameters
    ----------
    prog : str
        The program's name, for the help.

    Returns
    -------
    int
        Exit status.
    """
    arguments = sys.argv[1:]
    os.environ.update(thread_environment(threads_from_arguments(arguments)))
    from .command_line.run import run
    from .command_line.verbs import VERBS

    return run(VERBS, arguments, prog)


if __name__ == "__main__":
    sys.exit(main())
