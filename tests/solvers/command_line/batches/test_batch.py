"""Many files at once: the good ones are done, whatever happens to the others."""

import json
import shutil
from pathlib import Path
from time import process_time

import pytest

from solvers.command_line.arguments import unique_targets
from solvers.command_line.batches import tasks
from solvers.command_line.sharing import fingerprints
from solvers.errors import InvalidSettingError
from solvers.recordings import read_bvh

OTHER_BUILD = "Results of another version of Mocap Assist that are made again: 1.\n"


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
        monkeypatch.setattr("solvers.command_line.sharing.fingerprints.build", lambda: "99.0.0")

    _, printed, err = call(*words)

    assert "Already made." not in printed
    assert err == (OTHER_BUILD if change == "version" else "")


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
from solvers.command_line.arguments import OutputKind, Outcome, Verb, VerbWork

def no_options(parser):
    pass

def perform(task, prepared, progress):
    if "bad" in task.source.name:
        os._exit(9)
    return Outcome("Done.")

WORK = VerbWork(no_options, perform)

if __name__ == "__main__":
    verb = Verb("Die of some files.", "__main__:WORK", OutputKind.WORDS)
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


def test_start_of_a_batch_is_linear_in_its_takes(tmp_path):
    """Comparing each take with each other one took 23 s for 8,000 takes; this takes 0.4 s."""
    names = [Path(f"day{number % 20}/take{number}.bvh") for number in range(8000)]
    began = process_time()

    targets = [tmp_path / "out" / path for path in unique_targets(names, [".bvh"] * len(names))]
    tasks._check_overwriting([tmp_path / path for path in names], targets)

    assert process_time() - began < 5.0
    with pytest.raises(InvalidSettingError, match=r"both be written to .*take7\.bvh"):
        tasks._check_overwriting([tmp_path / "other"], [*targets, targets[7]])


def test_folder_of_examples_is_listed_once_for_all_takes(
    call, leg_file, twin_file, tmp_path, monkeypatch
):
    examples, stamped, stamp = tmp_path / "examples", [], fingerprints._stamp
    examples.mkdir()
    shutil.copy(leg_file, examples / "walk.bvh")
    monkeypatch.setattr(
        fingerprints, "_stamp", lambda file: stamped.append(file.name) or stamp(file)
    )
    words = ["denoise", leg_file, twin_file, "--output-folder", tmp_path / "out"]

    assert call(*words, "--train", examples)[0] == 0

    assert (stamped.count("examples"), stamped.count("walk.bvh")) == (1, 1)
    (examples / "walk.bvh").touch()
    assert "Already made." not in call(*words, "--train", examples)[1]
