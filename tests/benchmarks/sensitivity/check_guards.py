"""Check that the test of each guard fails without it.

    python -m tests.benchmarks.sensitivity.check_guards                 # all guards, minutes
    python -m tests.benchmarks.sensitivity.check_guards markers/        # those that hold this

Each guard of `guards.py` gets the value without effect in a process of its own, where its test
then runs.
"""

import subprocess
import sys

from .constants import FAMILIES, ROOT, Constant, constants_of
from .evaluate import replace_on_import
from .guards import GUARDS, Guard

WORDS = {0: "PASSES WITHOUT IT", 1: "fails without it"}


def main() -> None:
    """Check the guards whose key holds the argument."""
    wanted = sys.argv[1] if len(sys.argv) > 1 else ""
    useless = 0
    for key, guard in GUARDS.items():
        if wanted in key:
            code = subprocess.run(
                [sys.executable, "-m", __spec__.name, "--one", key],
                cwd=ROOT, stdout=subprocess.DEVNULL, check=False,
            ).returncode  # fmt: skip
            useless += code != 1
            print(f"{key}: {WORDS.get(code, f'ENDS WITH {code}')} ({guard.test})", flush=True)
    raise SystemExit(bool(useless))


def constant_of(key: str) -> Constant:
    """Return the constant of a key."""
    return next(each for family in FAMILIES for each in constants_of(family) if each.key == key)


def run_without(constant: Constant, guard: Guard) -> int:
    """Run the test of a guard without the guard; return the exit code of pytest."""
    import pytest  # after the import hook: conftest imports solvers

    replace_on_import(constant, guard.without)
    return int(
        pytest.main(["-x", "-q", "-p", "no:cacheprovider", f"tests/solvers/{guard.test}"])
    )


if __name__ == "__main__":
    if sys.argv[1:2] == ["--one"]:
        raise SystemExit(run_without(constant_of(sys.argv[2]), GUARDS[sys.argv[2]]))
    main()
