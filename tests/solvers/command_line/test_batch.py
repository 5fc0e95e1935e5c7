"""Many files at once: the good ones are done, whatever happens to the others."""

import json
import shutil
from pathlib import Path

import pytest

from solvers.recordings import read_bvh


@pytest.fixture
def twin_file(leg_file) -> Path:
    return Path(shutil.copy(leg_file, leg_file.with_name("twin.bvh")))


def test_output_folder_resumes_in_a_second_run(call, leg_file, tmp_path):
    twin = tmp_path / "twin.bvh"
    twin.write_bytes(leg_file.read_bytes())
    folder = tmp_path / "out"
    words = ["convert", leg_file, twin, "--output-folder", folder]
    assert call(*words)[0] == 0
    first = (folder / "leg.bvh").stat().st_mtime_ns
    (folder / "twin.bvh").unlink()

    _, printed, _ = call(*words)

    assert printed.count("Already made.") == 1
    assert (folder / "leg.bvh").stat().st_mtime_ns == first
    assert (folder / "twin.bvh").exists()


@pytest.mark.parametrize("change", ["options", "source", "again", "version"])
def test_output_is_made_again_when_the_result_would_differ(
    call, leg_file, tmp_path, change, monkeypatch
):
    words = ["convert", leg_file, "--output-folder", tmp_path / "out"]
    call(*words)
    if change == "options":
        words += ["--scale", 0.5]
    if change == "source":
        leg_file.write_bytes(leg_file.read_bytes() + b"\n")
    if change == "again":
        words += ["--again"]
    if change == "version":
        monkeypatch.setattr(
            "solvers.command_line.sharing.fingerprints.version", lambda: "99.0.0"
        )

    _, printed, _ = call(*words)

    assert "Already made." not in printed


def test_one_bad_file_does_not_stop_the_others(call, leg_file, tmp_path):
    bad = tmp_path / "bad.bvh"
    bad.write_text("HIERARCHY\nMOTION\n")
    folder = tmp_path / "out"

    status, printed, error_output = call(
        "convert", bad, leg_file, tmp_path / "gone.bvh", "--output-folder", folder, "--json"
    )

    assert status == 2
    assert sorted(path.name for path in folder.iterdir()) == [".mocap_assist", "leg.bvh"]
    lines = [json.loads(line) for line in printed.splitlines()]
    assert [("error" in line) for line in lines] == [True, False, True]
    assert error_output.count("\n") == 2
    assert "There is no file" in error_output


def test_parallel_jobs_give_the_same_files(start, leg_file, twin_file, tmp_path):
    done = start(
        "convert", leg_file, twin_file, "--jobs", 2, "--output-folder", tmp_path / "out"
    )

    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.count("120 frames at 60 Hz, 4 joints; ") == 2
    for name in ("leg.bvh", "twin.bvh"):
        assert (tmp_path / "out" / name).read_bytes() == leg_file.read_bytes()


def test_parallel_jobs_name_the_failed_file_and_do_the_others(
    start, leg_file, twin_file, tmp_path
):
    bad = tmp_path / "bad.bvh"
    bad.write_text("HIERARCHY\nMOTION\n")

    done = start(
        "denoise", leg_file, bad, twin_file, "--train", leg_file, "--json",
        "--jobs", 2, "--output-folder", tmp_path / "out",
    )  # fmt: skip

    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "bad.bvh" in done.stderr
    figures = {
        Path(each["input"]).name: each for each in map(json.loads, done.stdout.splitlines())
    }
    assert {name for name, each in figures.items() if "error" in each} == {"bad.bvh"}
    written = {path.name for path in (tmp_path / "out").glob("*.bvh")}
    assert written == {"leg.bvh", "twin.bvh"}
    assert read_bvh(tmp_path / "out" / "twin.bvh").n_frames == 120


DEADLY = """
import os, sys
from solvers.command_line.run import run
from solvers.command_line.verb_description import OutputKind, Outcome, Verb

def no_options(parser):
    pass

def perform(task, prepared, progress):
    if "bad" in task.source.name:
        os._exit(9)
    return Outcome("Done.")

if __name__ == "__main__":
    verb = Verb("Die of some files.", no_options, perform, OutputKind.WORDS)
    sys.exit(run({"die": verb}, sys.argv[1:], "deadly"))
"""


def test_crashed_process_loses_only_its_own_file(start, tmp_path, monkeypatch):
    """As the system does to a process that takes all memory."""
    monkeypatch.setenv("PYTHONPATH", ".")
    program = tmp_path / "deadly.py"
    program.write_text(DEADLY)

    done = start("die", "a", "bad", "b", "c", "d", "--jobs", 2, program=[program])

    assert done.returncode == 2
    assert done.stdout.count("Done.") == 4
    assert done.stderr.startswith("bad: its process crashed")
    assert done.stderr.count("\n") == 1
