"""Records of a batch that are damaged, too large or no files."""

import json
import os

import pytest

from solvers.command_line.sharing import Records, records


@pytest.mark.parametrize(
    "change", [{"output": "../x.bvh"}, {"output": "/x.bvh"}, {"error": 1}, {"figures": []}]
)
def test_records_that_point_elsewhere_or_are_damaged_are_ignored(
    call, leg_file, tmp_path, change
):
    out = tmp_path / "out"
    call("convert", leg_file, "--output-folder", out)
    (file,) = out.glob(".mocap_assist/*.json")
    record = {**json.loads(file.read_text()), "output": "x.bvh", **change}
    Records(out).file(record["output"]).write_text(json.dumps(record))
    file.with_name("leg.bvh.json").write_text(file.read_text())

    status, printed, _ = call("report", out)

    assert (status, printed) == (0, f"done    {out / 'leg.bvh'}\n1 done, 0 failed\n")


@pytest.mark.parametrize("verb", ["convert", "report"])
def test_record_that_is_too_large_is_named(call, leg_file, tmp_path, monkeypatch, verb):
    out = tmp_path / "out"
    call("convert", leg_file, "--output-folder", out)
    (file,) = out.glob(".mocap_assist/*.json")
    monkeypatch.setattr(records, "MAX_BYTES", 10)

    words = ("report",) if verb == "report" else ("convert", leg_file, "--output-folder")
    status, _, err = call(*words, out)

    assert status == 2
    assert f"{file} is too large for records of a batch; move it away to start again." in err


def test_former_record_that_is_too_large_is_named(call, leg_file, tmp_path, monkeypatch):
    out = tmp_path / "out"
    out.mkdir()
    (out / "mocap_assist.json").write_text('{"leg.bvh": {}}')
    monkeypatch.setattr(records, "MAX_BYTES", 10)

    status, _, err = call("convert", leg_file, "--output-folder", out)

    assert (status, "mocap_assist.json is too large for records" in err) == (2, True)


@pytest.mark.parametrize("name", [".mocap_assist/other.json", "mocap_assist.json"])
@pytest.mark.parametrize("kind", ["pipe", "device", "folder"])
def test_records_that_are_no_files_are_ignored(call, leg_file, tmp_path, name, kind):
    file = tmp_path / "out" / name
    file.parent.mkdir(parents=True)
    if kind == "pipe":
        os.mkfifo(file)
    elif kind == "device":
        file.symlink_to("/dev/zero")
    else:
        file.mkdir()

    for words in (("convert", leg_file, "--output-folder"), ("report",)):
        status, _, err = call(*words, tmp_path / "out")

        assert (status, err) == (0, "")
    assert json.loads((tmp_path / "out" / "report.json").read_text())["done"] == 1
