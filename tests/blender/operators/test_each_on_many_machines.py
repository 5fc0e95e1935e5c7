"""`each` on several machines: shards of a manifest, one report."""

import json


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
