"""Any number of processes share one batch: no take is lost, and none is made twice."""

import json
import os
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path

from solvers.command_line.arguments import read
from solvers.command_line.batches import batch
from solvers.command_line.batches.report import Entry, write_report
from solvers.command_line.sharing import Records, claimed

N_TAKES = 24
ROOT = Path(__file__).parents[4]
N_PROCESSES = 6
NOTING = "import sys; open(sys.argv[1], 'a').write(sys.argv[2] + chr(10))"
HOLDER = """
import os, sys
from pathlib import Path
from solvers.command_line.batches.report import Entry, write_report
from solvers.command_line.sharing import Records, claimed
with claimed(Path(sys.argv[1])):
    print("held", flush=True)
    sys.stdin.read(1)
    os._exit(9)
"""


def run_together(command_lines):
    """Run command lines at once in processes of their own; return their standard outputs."""
    running = [
        subprocess.Popen(
            [sys.executable, "-B", "-m", "solvers", *map(str, words)],
            cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        )
        for words in command_lines
    ]  # fmt: skip
    printed = [each.communicate() for each in running]
    assert [each.returncode for each in running] == [0] * len(running), printed
    return [out for out, _ in printed]


def test_processes_at_once_lose_no_take_and_make_none_twice(small_batch, tmp_path, records_in):
    out, notes = tmp_path / "out", tmp_path / "notes"
    hook = f'{sys.executable} -c "{NOTING}" {notes} {{output}}'
    words = ["convert", small_batch, "--output-folder", out, "--after", hook]

    printed = run_together([words] * N_PROCESSES)

    names = {path.name for path in small_batch.iterdir()}
    assert {path.name for path in out.glob("*.bvh")} == names
    assert {name for name, each in records_in(out).items() if each["status"] == "done"} == names
    made = Counter(Path(line).name for line in notes.read_text().splitlines())
    assert made == dict.fromkeys(names, 1)
    assert sum(text.count("5 frames at 10 Hz") for text in printed) == N_TAKES
    assert not list(out.rglob("*.claim"))


def test_processes_on_different_takes_keep_all_records(small_batch, tmp_path, records_in):
    out, sources = tmp_path / "out", sorted(small_batch.iterdir())

    run_together(
        ["convert", *sources[first : first + 8], "--output-folder", out]
        for first in range(0, N_TAKES, 8)
    )

    assert set(records_in(out)) == {path.name for path in sources}


def test_take_of_another_process_is_skipped_and_that_of_a_dead_one_is_made(
    call, leg_file, tmp_path
):
    out = tmp_path / "out"
    words = ["convert", leg_file, "--output-folder", out]
    call(*words)
    (record,) = out.glob(".mocap_assist/*.json")
    (out / "leg.bvh").unlink()
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER, str(record.with_suffix(""))],
        cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    ) as holder:  # fmt: skip
        assert holder.stdout.readline() == "held\n"
        own = out / ".leg.0123456789ab.bvh"
        own.write_text("half")

        status, printed, _ = call(*words)

        host = os.uname().nodename
        assert (status, printed) == (
            0, f"Skipped: another process on {host} is working on it.\n",
        )  # fmt: skip
        assert own.exists()
        assert not (out / "leg.bvh").exists()
        holder.kill()
        holder.wait()

    status, printed, _ = call(*words)

    assert (status, printed.count("120 frames")) == (0, 1)
    assert {path.name for path in out.iterdir()} == {".mocap_assist", "leg.bvh"}
    assert [path.name for path in (out / ".mocap_assist").iterdir()] == [record.name]


def test_report_of_two_shards_equals_that_of_one_run(call, small_batch, tmp_path):
    for number in range(4, N_TAKES):
        (small_batch / f"take{number:02}.bvh").unlink()
    (small_batch / "bad.bvh").write_text("HIERARCHY\nMOTION\n")
    out = tmp_path / "out"
    call("convert", small_batch, "--output-folder", out, "--report")
    expected = [(out / name).read_bytes() for name in ("report.json", "report.html")]
    complete = call("report", out)
    assert [(out / name).read_bytes() for name in ("report.json", "report.html")] == expected
    shutil.rmtree(out)
    for number in (1, 2):
        call(
            "convert", small_batch, "--output-folder", out, "--shard", f"{number}/2", "--report"
        )

    status, printed, err = call("report", out)

    assert (status, printed, err) == complete
    assert (status, err.count("\n")) == (2, 1)
    assert "4 done, 1 failed" in printed
    assert [(out / name).read_bytes() for name in ("report.json", "report.html")] == expected


def test_reports_at_once_are_complete(small_batch, tmp_path):
    out = tmp_path / "out"
    words = ["convert", small_batch, "--output-folder", out, "--report"]

    run_together([[*words, "--shard", f"{number}/2"] for number in (1, 2)])

    report = json.loads((out / "report.json").read_text())
    assert (report["done"], len(report["files"])) == (N_TAKES, N_TAKES)
    assert not [path for path in out.iterdir() if path.name.startswith(".report")]


def test_report_needs_records(call, tmp_path):
    for folder in (tmp_path, tmp_path / "gone"):
        status, _, err = call("report", folder)
        assert (status, err) == (
            2, f"There are no records of a batch in the folder {folder}.\n",
        )  # fmt: skip
    assert not list(tmp_path.iterdir())


def test_report_is_written_again_when_a_record_is_added_meanwhile(tmp_path):
    Records(tmp_path).prepare()
    one, two = (
        Entry(f"{name}.bvh", f"{name}.bvh", Path(f"{name}.png"), {}, identifier=name)
        for name in ("one", "two")
    )
    found = iter([[one], [one, two], [one, two]])

    assert write_report(tmp_path, "convert", lambda: next(found)) == ()

    assert json.loads((tmp_path / "report.json").read_text())["done"] == 2


def test_report_is_left_to_the_holders_of_takes_that_add_records(tmp_path):
    """While others process takes, each look finds a new record; each writes it at its end."""
    records, n_looks = Records(tmp_path), 0
    records.prepare()

    def look():
        nonlocal n_looks
        n_looks += 1
        assert n_looks <= 2, "the report is written again and again"
        return [
            Entry("a.bvh", f"{number}.bvh", Path("a.png"), identifier=str(number))
            for number in range(n_looks)
        ]

    with claimed(records.claim("other.bvh")):
        assert write_report(tmp_path, "convert", look) == ()

    report = json.loads((tmp_path / "report.json").read_text())
    assert (report["pending"], report["not come to"], len(report["files"])) == (1, 1, 1)


def test_files_of_others_in_the_output_folder_stay(call, leg_file, tmp_path):
    out = tmp_path / "out"
    words = ["convert", leg_file, "--output-folder", out, "--report"]
    call(*words)
    (file,) = out.glob(".mocap_assist/*.json")
    others = [
        out / ".leg.0123456789ab.bvh", out / ".leg.bvh", out / "notes.txt",
        out / ".report.0123456789ab.html", file.with_name("notes.txt"),
        file.with_name("other.0123456789abcdef.json"), file.with_name("other.1.claim"),
    ]  # fmt: skip
    for other in others:
        other.write_text("of another process or person")

    for extra in ([], ["--again"], ["--scale", "0.5"]):
        assert call(*words, *extra)[0] == 0
    call("report", out)

    assert {other.read_text() for other in others} == {"of another process or person"}


def test_output_folder_that_vanishes_is_one_sentence(
    call, small_batch, tmp_path, monkeypatch, records_in
):
    out, aside = tmp_path / "out", tmp_path / "aside"
    hook = f"{sys.executable} -c 'import os, sys; os.rename(*sys.argv[1:])' {out} {aside}"

    words = ["convert", small_batch, "--output-folder", out]
    status, _, err = call(*words, "--report", "--after", hook)

    assert status == 2
    assert err == (
        f"The output folder {out} is gone; the batch stops. Run it again to continue.\n"
    )
    assert not out.exists()
    aside.rename(out)
    status, _, _ = call(*words)
    assert (status, len(records_in(out))) == (0, N_TAKES)


def test_output_folder_that_vanishes_before_a_picture_is_not_made_again(
    call, leg_file, tmp_path, monkeypatch
):
    out, aside = tmp_path / "out", tmp_path / "aside"

    def move_and_read(*arguments):
        out.rename(aside)
        return read(*arguments)

    monkeypatch.setattr(batch, "read", move_and_read)

    status, _, err = call("convert", leg_file, "--output-folder", out, "--report")

    assert (status, out.exists()) == (2, False)
    assert err == (
        f"The output folder {out} is gone; the batch stops. Run it again to continue.\n"
    )


def test_record_of_an_earlier_version_is_taken_up(call, small_batch, tmp_path, records_in):
    """It was one file for the folder, with the paths of the inputs."""
    out, words = tmp_path / "out", ["convert", small_batch, "--output-folder", tmp_path / "out"]
    call(*words)
    former = {}
    for name, record in records_in(out).items():
        note = {**record["fingerprint"], "figures": {"n_frames": 5}}
        note["source"][0] = str(small_batch / name)
        former[name] = note
    shutil.rmtree(out / ".mocap_assist")
    (out / "mocap_assist.json").write_text(json.dumps(former))

    status, printed, _ = call(*words)

    assert (status, printed.count("Already made.")) == (0, N_TAKES)
    assert records_in(out)["take07.bvh"]["figures"] == {"n_frames": 5}
    assert json.loads((out / "mocap_assist.json").read_text()) == former
