"""`each` on several machines: shards of a manifest, one report."""

import json
import re
import sys


def test_shards_of_a_manifest_give_one_report(command, load, tmp_path):
    samples, recordings = load("solvers.samples"), load("solvers.recordings")
    walk = samples.walking_gait(samples.GaitSettings(duration=0.5, frame_rate=10.0))
    names = [f"take{number}.bvh" for number in range(4)]
    for name in names:
        recordings.write_bvh(walk, tmp_path / name)
    (tmp_path / "takes.txt").write_text("\n".join(names))
    out = tmp_path / "out"
    words = ["each", "--manifest", tmp_path / "takes.txt", "--output-folder", out, "--wait"]

    counts = []
    for number in (1, 2):
        status, printed, err = command(*words, "--shard", f"{number}/2", "--", "import")
        assert (status, err) == (0, "")
        counts.append(printed.count("Done."))
    status, printed, err = command("report", out)

    assert sum(counts) == 4 and all(counts)
    assert (status, err) == (0, "")
    assert printed.endswith("4 done, 0 failed\n")
    report = json.loads((out / "report.json").read_text())
    assert (report["verb"], report["done"]) == ("import", 4)
    assert command("report", tmp_path)[2].startswith("There are no records of a batch in")


def test_terminal_shows_how_many_files_are_done(command, load, tmp_path, monkeypatch):
    samples, recordings = load("solvers.samples"), load("solvers.recordings")
    walk = samples.walking_gait(samples.GaitSettings(duration=0.5, frame_rate=10.0))
    for name in ("one.bvh", "two.bvh"):
        recordings.write_bvh(walk, tmp_path / name)
    files = [tmp_path / "one.bvh", tmp_path / "two.bvh"]
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)

    status, printed, shown = command(
        "each", *files, "--output-folder", tmp_path / "out", "--jobs", 2, "--", "import"
    )

    assert (status, printed.count("Done.")) == (0, 2)
    assert re.findall(r"\[(\d)/2\]", shown) == ["0", "1", "2"]
    assert shown.endswith(" \r"), "the last count stays before the shell's prompt"
