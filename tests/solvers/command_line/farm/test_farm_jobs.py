"""The job templates for schedulers run a batch in parts, as they stand."""

import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[4]
JOBS = ROOT / "solvers" / "command_line" / "farm" / "templates"
COMMAND = f"env PYTHONPATH={ROOT} {sys.executable} -m solvers"
OPENJD = [sys.executable, "-m", "openjd"]

pytestmark = pytest.mark.skipif(shutil.which("bash") is None, reason="needs bash")


@pytest.fixture
def manifest(small_batch) -> Path:
    """A list of four takes."""
    path = small_batch / "takes.txt"
    path.write_text("".join(f"take{number:02}.bvh\n" for number in range(4)))
    return path


@pytest.mark.skipif(find_spec("openjd") is None, reason="needs the package openjd-cli")
def test_openjd_template_is_valid_and_runs(manifest, tmp_path, records_in):
    template, out = JOBS / "openjd.yaml", tmp_path / "out"
    given = {
        "Verb": "convert", "Manifest": manifest, "OutputFolder": out, "Shards": 2,
        "Options": "--scale 0.5", "Command": COMMAND,
    }  # fmt: skip
    parameters = [word for name, value in given.items() for word in ("-p", f"{name}={value}")]

    checked = run(*OPENJD, "check", template)
    ran = run(*OPENJD, "run", template, *parameters)

    assert checked.returncode == 0, checked.stdout
    assert ran.returncode == 0, ran.stdout
    assert set(records_in(out)) == {f"take{number:02}.bvh" for number in range(4)}
    assert (out / "report.html").exists()
    assert {each["fingerprint"]["options"]["scale"] for each in records_in(out).values()} == {
        "0.5"
    }


def test_slurm_array_shares_the_takes(manifest, tmp_path, records_in):
    out = tmp_path / "out"
    sizes = []

    for number in (1, 2):
        ran = slurm(number, 2, manifest, out, "convert", "--scale", "0.5")
        assert (ran.returncode, ran.stderr) == (0, "")
        sizes.append(len(records_in(out)))

    assert 0 < sizes[0] < sizes[1] == 4
    assert (out / "report.html").exists()


def test_part_of_a_slurm_array_is_refused(manifest, tmp_path):
    ran = slurm(2, 3, manifest, tmp_path / "out", "convert", count=2)

    assert (ran.returncode, ran.stdout) == (2, "")
    assert ran.stderr.startswith("The array must be 1-N")
    assert not (tmp_path / "out").exists()


def slurm(number, last, *words, count=None):
    """Run a task of the array as SLURM does."""
    variables = {
        "SLURM_ARRAY_TASK_ID": number,
        "SLURM_ARRAY_TASK_MAX": last,
        "SLURM_ARRAY_TASK_COUNT": count or last,
    }
    environment = {name: str(value) for name, value in variables.items()}
    return run("bash", JOBS / "slurm.sh", *words, MOCAP_ASSIST=COMMAND, **environment)


def run(*words, **environment):
    """Run a command in a folder that is not the checkout's."""
    return subprocess.run(
        [*map(str, words)], cwd="/", env=os.environ | environment, capture_output=True,
        text=True, check=False, timeout=500,
    )  # fmt: skip
