"""A button starts a process that imports the solvers: what takes long to import must wait."""

import subprocess
import sys

import pytest

SLOW = ("scipy.signal", "scipy.stats", "mujoco", "PIL", "matplotlib", "sklearn")


@pytest.mark.parametrize("name", ["workflows", "command_line"])
def test_slow_libraries_are_imported_on_demand(name):
    code = f"import sys, solvers.{name}; print(*sys.modules)"
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert set(run.stdout.split()).isdisjoint(SLOW)


def test_reading_needs_no_scipy():
    """A background Blender reads files of other programs: its start is what they wait for."""
    code = "import sys, solvers.motion, solvers.recordings; print(*sys.modules)"
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert "scipy" not in run.stdout.split()
