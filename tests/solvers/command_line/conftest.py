"""Fixtures of the command-line tests."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from solvers.command_line.run import run
from solvers.command_line.verbs import VERBS
from solvers.recordings import write_bvh
from solvers.samples import GaitSettings, walking_gait

ROOT = Path(__file__).parents[3]


@pytest.fixture
def call(capsys):
    """Run a command line in this process; returns exit status, stdout, stderr."""

    def command(*words) -> tuple[int, str, str]:
        try:
            status = run(VERBS, [str(word) for word in words], "solvers")
        except SystemExit as stopped:
            status = stopped.code
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return command


@pytest.fixture
def start():
    """Run `python -m solvers`, or another program of Python, in a process of its own."""

    def command(*words, program=("-m", "solvers"), **options) -> subprocess.CompletedProcess:
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | options
        return subprocess.run(
            [sys.executable, "-B", *map(str, program), *map(str, words)],
            cwd=ROOT, timeout=500, text=True, check=False,
            env=os.environ | {"PYTHONWARNINGS": "error"}, **streams,
        )  # fmt: skip

    return command


@pytest.fixture
def leg_file(swinging_leg, tmp_path) -> Path:
    write_bvh(swinging_leg, tmp_path / "leg.bvh")
    return tmp_path / "leg.bvh"


@pytest.fixture
def small_batch(tmp_path) -> Path:
    """A folder of 24 small takes."""
    folder = tmp_path / "takes"
    folder.mkdir()
    walk = walking_gait(GaitSettings(duration=0.5, frame_rate=10.0))
    write_bvh(walk, folder / "take00.bvh")
    for number in range(1, 24):
        shutil.copy(folder / "take00.bvh", folder / f"take{number:02}.bvh")
    return folder


@pytest.fixture
def records_in():
    """Return the records in an output folder by output."""

    def read(folder: Path) -> dict[str, dict]:
        files = folder.glob(".mocap_assist/*.json")
        return {
            record["output"]: record for record in map(json.loads, map(Path.read_text, files))
        }

    return read
