"""A fault of ours over one file stops no other file, picture or report."""

import json
import sys

import pytest

from solvers.command_line.arguments import (
    Outcome,
    OutputKind,
    Verb,
    VerbWork,
    add_reading_options,
    write,
)
from solvers.command_line.run import run
from solvers.progress import unwatched
from solvers.recordings import read_bvh

FAULT = "this is a bug in Mocap Assist"


@pytest.fixture
def perform(capsys, monkeypatch):
    """Run a verb that does this to each file; returns exit status, stdout and stderr."""

    def call(work, *words, makes=OutputKind.FILES):
        does = VerbWork(add_reading_options, work)
        monkeypatch.setattr(sys.modules[__name__], "WORK", does, raising=False)
        verb = Verb("Test.", f"{__name__}:WORK", makes)
        status = run({"test": verb}, ["test", *map(str, words)], "solvers")
        return status, *capsys.readouterr()

    return call


@pytest.fixture
def legs(leg_file, tmp_path):
    (tmp_path / "odd.bvh").write_bytes(leg_file.read_bytes())
    (tmp_path / "twin.bvh").write_bytes(leg_file.read_bytes())
    return [leg_file, tmp_path / "odd.bvh", tmp_path / "twin.bvh"]


def copy(task, prepared, progress):
    write(read_bvh(task.source), task.target, unwatched)
    return Outcome("Done.", {"n_frames": 3})


@pytest.mark.parametrize("error", [IndexError, OverflowError, RecursionError, UnicodeError])
def test_other_files_are_processed_when_one_raises(perform, legs, tmp_path, error):
    def work(task, prepared, progress):
        if task.source.name == "odd.bvh":
            raise error
        return copy(task, prepared, progress)

    status, out, err = perform(work, *legs, "--output-folder", tmp_path / "out")

    assert (status, out.count("Done.")) == (2, 2)
    assert err.count("\n") == 1
    assert f"odd.bvh: {FAULT} ({error.__name__} at " in err
    assert {path.name for path in (tmp_path / "out").glob("*.bvh")} == {"leg.bvh", "twin.bvh"}


@pytest.mark.parametrize("figures", [{"a": float("nan")}, {"a": {1, 2}}])
def test_report_and_lines_name_the_file_when_its_figures_cannot_be_written(
    perform, legs, tmp_path, figures
):
    def work(task, prepared, progress):
        done = copy(task, prepared, progress)
        return Outcome("Done.", figures) if task.source.name == "odd.bvh" else done

    out_folder = tmp_path / "out"
    status, out, err = perform(work, *legs, "--output-folder", out_folder, "--report", "--json")

    assert (status, err.count("\n")) == (2, 1)
    assert f"odd.bvh: {FAULT}" in err
    lines = {json.loads(line)["input"]: json.loads(line) for line in out.splitlines()}
    assert [str(leg) for leg in legs if "error" in lines[str(leg)]] == [str(legs[1])]
    report = json.loads((out_folder / "report.json").read_text())
    assert [FAULT in each.get("error", "") for each in report["files"]] == [False, True, False]


@pytest.mark.parametrize("figures", ['{"a": NaN}', '{"after": {"mean_jitter_m_per_s3": "x"}}'])
def test_report_names_the_file_when_its_stored_figures_are_invalid(
    perform, legs, tmp_path, figures
):
    words = [*legs, "--output-folder", tmp_path / "out", "--report"]
    perform(copy, *words)
    (file,) = tmp_path.glob("out/.mocap_assist/odd.bvh.*.json")
    record = json.loads(file.read_text())
    file.write_text(json.dumps({**record, "figures": json.loads(figures)}))

    status, out, err = perform(copy, *words)

    assert (status, out.count("Already made."), err.count("\n")) == (2, 3, 1)
    assert f"odd.bvh: {FAULT}" in err
    assert (tmp_path / "out" / "report.html").read_text().count(FAULT) == 1


def test_take_is_written_and_the_picture_is_named_when_drawing_raises(
    perform, legs, tmp_path, monkeypatch
):
    def fail(*_):
        raise IndexError

    monkeypatch.setattr("solvers.command_line.batches.batch.draw_stick_figures", fail)
    words = [legs[0], "--output-folder", tmp_path / "out", "--report"]

    first, again = perform(copy, *words), perform(copy, *words)

    for status, out, err in (first, again):
        assert (status, out.count("\n"), err.count("\n")) == (2, 1, 1)
        assert f"leg.bvh: {FAULT} (IndexError at solvers/command_line/batches/batch.py:" in err
    assert read_bvh(tmp_path / "out" / "leg.bvh").n_frames == 120
    assert "Already made." in again[1]


@pytest.mark.parametrize("depth", [70, 900, 100_000])
def test_files_are_made_again_when_the_record_is_nested_deeply(call, legs, tmp_path, depth):
    words = ["convert", *legs, "--output-folder", tmp_path / "out"]
    call(*words)
    (tmp_path / "out" / "mocap_assist.json").write_text(nested(depth))
    records = list(tmp_path.glob("out/.mocap_assist/*.json"))
    for record in records:
        record.write_text(nested(depth))

    status, out, err = call(*words)

    assert (status, err, out.count("120 frames")) == (0, "", 3)
    assert all(json.loads(record.read_text())["status"] == "done" for record in records)


def nested(depth):
    return '{"leg.bvh": ' + '{"a":' * depth + "1" + "}" * depth + "}"
