"""One module sets the threads of linear algebra, whatever the environment says."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from solvers.processes.threads import VARIABLES, thread_environment, threads_from_arguments

ROOT = Path(__file__).parents[3]


def test_no_other_module_names_the_variables():
    named = re.compile("|".join(VARIABLES))
    found = {
        path.relative_to(ROOT).as_posix()
        for layer in ("solvers", "mocap_assist", "operators")
        for path in (ROOT / layer).rglob("*.py")
        if named.search(path.read_text(encoding="utf-8"))
    }
    assert found == {"solvers/processes/threads.py"}


def test_numpy_is_not_imported_before_the_variables_are_set():
    code = (
        "import sys, solvers.__main__\n"
        "from solvers.processes import locks, parent, scratch, threads, workers\n"
        "sys.exit('numpy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=False).returncode == 0


def test_all_variables_have_the_number():
    assert thread_environment(3) == dict.fromkeys(VARIABLES, "3")


@pytest.mark.parametrize(
    ("words", "number"),
    [
        ("denoise a b", 1),
        ("denoise a b --threads 4", 4),
        ("denoise --threads=3 a b --train c d", 3),
        ("denoise a b --thread 2", 2),
        ("denoise a b --train c d", 1),
        ("denoise a b --threads", 1),
        ("denoise a b --threads 0", 1),
        ("denoise a b --threads -2", 1),
        ("denoise a b --threads many", 1),
        ("--help", 1),
    ],
)
def test_number_of_threads_is_found_before_the_command_line_is_parsed(words, number):
    assert threads_from_arguments(words.split()) == number
