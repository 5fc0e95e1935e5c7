"""Many files from the command line, each by a Blender of its own."""

import json

import pytest
from odd_files import close


@pytest.fixture
def takes(load, tmp_path):
    """A folder of three takes, one of them broken, one in a folder of its own."""
    samples = load("solvers.samples")
    write_bvh = load("solvers.recordings").write_bvh
    walk = samples.walking_gait(samples.GaitSettings(duration=2.0, frame_rate=30.0))
    raw = samples.corrupt(walk, samples.CorruptionSettings(jitter=3.0))
    folder = tmp_path / "takes"
    (folder / "second").mkdir(parents=True)
    write_bvh(raw, folder / "one.bvh")
    write_bvh(raw, folder / "second" / "two.bvh")
    (folder / "bad.bvh").write_text("HIERARCHY\nMOTION\n")
    return folder


def test_import_command_reads_files_and_folders_into_one_scene(blank, command, takes, tmp_path):
    target = tmp_path / "all.blend"

    status, out, err = command("import", takes, "--output", target, "--json")

    assert status == 2
    assert "bad.bvh" in err
    said = json.loads(next(line for line in out.splitlines() if line[:1] == "{"))
    assert said["objects"] == ["one", "two"]
    assert [each["n_frames"] for each in said["figures"]] == [60, 60]
    blank.ops.wm.open_mainfile(filepath=str(target))
    assert {"one", "two"} <= {each.name for each in blank.data.objects}


def test_each_command_imports_cleans_and_resumes(blank, command, takes, tmp_path):
    raw, clean = tmp_path / "raw", tmp_path / "clean"

    status, out, err = command(
        "each", takes, "--output-folder", raw, "--jobs", 2, "--report",
        "--", "import", "--frame-rate", "update scene FPS",
    )  # fmt: skip

    assert status == 2
    assert "1 of 3 files failed" in err and "bad.bvh" in err
    assert out.count("bad.bvh") == 1
    made = {path.relative_to(raw).as_posix() for path in raw.rglob("*.blend")}
    assert made == {"one.blend", "second/two.blend"}
    report = json.loads((raw / "report.json").read_text())
    assert (report["done"], report["failed"]) == (2, 1)
    failures = [each["error"] for each in report["files"] if "error" in each]
    assert command("report", raw)[::2] == (2, f"{failures[0]}\n")
    for each in report["files"]:
        if "error" not in each:
            assert (each["joints"], each["n_frames"], each["frame_rate_hz"]) == (22, 60, 30.0)
            assert (each["gaps"], each["warnings"]) == (0, "")

    status, out, err = command(
        "each", raw, "--output-folder", clean, "--report", "--", "denoise", "--no-plant-feet"
    )
    assert (status, err) == (0, "")
    report = json.loads((clean / "report.json").read_text())
    assert all(
        each["after"]["mean_jitter_m_per_s3"] < 0.5 * each["before"]["mean_jitter_m_per_s3"]
        and (clean / each["picture"]).exists()
        for each in report["files"]
    )
    blank.ops.wm.open_mainfile(filepath=str(clean / "second" / "two.blend"))
    assert blank.data.objects["two"].animation_data.action.name == "two.clean"

    (clean / "one.blend").unlink()
    status, out, _ = command(
        "each", raw, "--output-folder", clean, "--", "denoise", "--no-plant-feet"
    )
    assert (status, out.count("Already made."), out.count("Done.")) == (0, 1, 1)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["each", "{takes}", "--output-folder", "{out}"], "Give the verb for each"),
        (["each", "{takes}", "--output-folder", "{out}", "--", "denoise"], "no .blend file in"),
        (["each", "{takes}/one.bvh", "--output-folder", "{out}", "--", "denoise"],
         "only import and capture read others"),
        (["each", "{takes}", "--output-folder", "{out}", "--jobs", "0", "--", "import"],
         "jobs is 0"),
        (["each", "{takes}", "--output-folder", "{out}", "--", "quality"], "saves no .blend"),
        (["each", "{takes}", "--output-folder", "{out}", "--", "import", "--frame-rat", "x"],
         "frame-rat"),
        (["each", "{takes}/gone.blend", "--output-folder", "{out}", "--", "denoise"],
         "There is no file"),
    ],
)  # fmt: skip
def test_each_command_reports_impossible_requests_at_once(
    command, takes, tmp_path, words, sentence
):
    folders = {"takes": takes, "out": tmp_path / "out"}

    status, _, err = command(*(word.format(**folders) for word in words))

    assert status == 2
    assert sentence in err
    assert err.count("\n") == 1


def test_blend_files_are_found_whatever_the_case_of_their_ending(load, tmp_path):
    (tmp_path / "take.BLEND").touch()

    found = load("mocap_assist.batch.each_verb")._blends_in(tmp_path)

    assert [path.name for path in found] == ["take.BLEND"]


def test_circular_link_and_missing_file_do_not_stop_other_files(command, takes, tmp_path):
    loop, out = tmp_path / "loop.bvh", tmp_path / "out"
    loop.symlink_to(loop)

    status, said, failed = command(
        "each", loop, tmp_path / "gone.bvh", takes / "one.bvh",
        "--output-folder", out, "--", "import",
    )  # fmt: skip

    assert status == 2
    assert "2 of 3 files failed" in failed
    assert "There is no file" in said
    assert (out / "one.blend").exists()


def test_each_command_cleans_markers_without_an_armature(blank, command, load, tmp_path, rng):
    tracks = load("solvers.motion").Tracks(
        ("a", "b", "c"),
        rng.normal(size=(3, 3)) + rng.normal(scale=0.002, size=(90, 3, 3)),
        30.0,
    )
    load("solvers.recordings").write_trc(tracks, tmp_path / "three.trc")
    command("import", tmp_path / "three.trc", "--output", tmp_path / "raw.blend")
    blank.ops.wm.open_mainfile(filepath=str(tmp_path / "raw.blend"))

    status, out, err = command("denoise", "--output", tmp_path / "clean.blend", "--json")

    assert (status, err) == (0, "")
    said = json.loads(next(line for line in out.splitlines() if line[:1] == "{"))
    assert said["armature"] == "three"
    assert said["action"].endswith(".clean")
    assert command("convert", tmp_path / "three_clean.trc")[0] == 0
    back = load("solvers.recordings").read_recording(tmp_path / "three_clean.trc")
    assert back.names == ("a", "b", "c")
    assert "no animated armature" in command("unbake", "--output", tmp_path / "x.blend")[2]


def test_each_reports_warnings_of_readers(blank, command, tmp_path):
    lines = ["mocap-assist-joints,1,units=m", "time,A.x,A.y,A.z,B.x,B.y,B.z,C.x,C.y,C.z"]
    lines += [f"{frame / 30 + 0.002 * (frame % 3)},1,2,{frame},1,1,1,,," for frame in range(40)]
    (tmp_path / "late.csv").write_text("\n".join(lines) + "\n")

    status, out, _ = command(
        "import", tmp_path / "late.csv", "--output", tmp_path / "late.blend", "--json"
    )

    assert status == 0
    (figures,) = json.loads(next(line for line in out.splitlines() if line[:1] == "{"))[
        "figures"
    ]
    assert (figures["joints"], figures["frame_rate_hz"]) == (3, 30.0)
    assert figures["warnings"] == (
        "Resampled to 30 Hz from its time stamps. Never observed: C."
        " The parents of the joints are unknown"
    )


def test_each_reports_a_folder_that_cannot_be_created(command, takes, tmp_path):
    (tmp_path / "in_the_way").write_text("a file where a folder should be")
    out = tmp_path / "in_the_way" / "out"

    status, _, err = command("each", takes, "--output-folder", out, "--", "import")

    assert (status, err.count("\n")) == (2, 1)
    assert "in_the_way" in err and "Traceback" not in err


def test_other_files_are_processed_when_one_raises(load, command, takes, tmp_path, monkeypatch):
    each_verb = load("mocap_assist.batch.each_verb")
    real = each_verb.remove_picture

    def forget(task):
        if task.source.name == "one.bvh":
            raise IndexError
        real(task)

    monkeypatch.setattr(each_verb, "remove_picture", forget)

    status, out, err = command(
        "each", takes, "--output-folder", tmp_path / "out", "--", "import"
    )

    assert (status, out.count("Done."), err.count("\n")) == (2, 1, 1)
    assert "2 of 3 files failed." in err and "Traceback" not in out + err
    assert "one.bvh: this is a bug in Mocap Assist (IndexError at " in out


def test_unreadable_folder_and_long_name_are_reported_before_blender_starts(
    command, takes, tmp_path, monkeypatch
):
    for name in ("bad.bvh", "one.bvh"):
        (takes / name).unlink()
    (takes / f"{'a' * 249}.blend").write_bytes(b"BLENDER")
    close(takes / "second", monkeypatch)

    status, out, err = command(
        "each", takes, "--output-folder", tmp_path / "out", "--", "denoise"
    )

    assert (status, err.count("\n"), out.count("\n")) == (2, 1, 2)
    assert "2 of 2 files failed." in err
    assert f"The output {'a' * 40}... needs a name of 259 bytes" in out
    assert f"The folder {takes / 'second'} cannot be opened" in out
    assert not list((tmp_path / "out").glob("*.blend"))
