"""The option --body: one of several people, or a result for each."""

import json

import numpy as np
import pytest
from joint_files import moving, ntu

from solvers.command_line.batches import tasks
from solvers.command_line.run import run
from solvers.command_line.verbs import VERBS
from solvers.recordings import read_recording


def main(words):
    return run(VERBS, words, "solvers")


@pytest.fixture
def crowd(tmp_path):
    """Anna is in all of 60 frames, Ben in the last 40, a ghost in one."""
    anna, ben = moving(60, 25, 1), moving(60, 25, 500)
    frames = [{"7": each} for each in anna]
    for index in range(20, 60):
        frames[index]["8"] = ben[index]
    frames[30]["9"] = ben[0]
    path = tmp_path / "crowd.skeleton"
    path.write_text(ntu(frames))
    return path


def test_convert_reads_and_reports_the_body_in_most_frames(crowd, tmp_path, capsys):
    assert main(["convert", str(crowd), str(tmp_path / "out.trc")]) == 0

    message = capsys.readouterr().out
    assert "Body 1 of 2. Left out: 2 (1.3 s, 67 % of the frames)" in message
    assert "--body" in message
    assert read_recording(tmp_path / "out.trc").visible[0].any()


def test_convert_writes_a_file_for_each_body(crowd, tmp_path, capsys):
    assert main(["convert", str(crowd), str(tmp_path / "out.trc"), "--body", "all"]) == 0

    one, two = (read_recording(tmp_path / f"out_{body}.trc") for body in (1, 2))
    assert not (tmp_path / "out.trc").exists() and not (tmp_path / "out_3.trc").exists()
    assert one.visible[0].any() and not two.visible[0].any()
    assert one.n_frames == two.n_frames == 60
    assert "false detection: 3" in capsys.readouterr().out


def test_one_body_keeps_the_name_of_the_target(crowd, tmp_path):
    words = ["convert", str(crowd), str(tmp_path / "out.trc"), "--body", "2"]
    assert main([*words, "--place-on-floor", "never"]) == 0

    expected = read_recording(crowd, body="2").tracks.positions
    np.testing.assert_allclose(
        read_recording(tmp_path / "out.trc").positions, expected, atol=1e-4
    )


def test_figures_of_every_body(crowd, capsys):
    assert main(["quality", str(crowd), "--body", "all", "--json"]) == 0

    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [line["body"] for line in lines] == ["1", "2"]
    assert lines[1]["missing_share"] == pytest.approx(1 / 3)


def test_batch_resumes_and_reports_every_body(crowd, tmp_path, capsys):
    folder = tmp_path / "out"
    words = ["convert", str(crowd), "--output-folder", str(folder), "--body", "all", "--report"]

    assert main(words) == 0
    assert main(words) == 0

    assert capsys.readouterr().out.count("Already made.") == 2
    files = [
        entry["output"] for entry in json.loads((folder / "report.json").read_text())["files"]
    ]
    assert [file.rpartition("/")[2] for file in files] == ["crowd_1.trc", "crowd_2.trc"]


@pytest.mark.parametrize("verb", ["convert", "quality"])
def test_unknown_body_is_one_sentence(crowd, tmp_path, capsys, verb):
    target = [str(tmp_path / "out.trc")] if verb == "convert" else []

    assert main([verb, str(crowd), *target, "--body", "Ben"]) == 2

    message = capsys.readouterr().err.strip()
    assert message.endswith("3 (0.0 s, 2 % of the frames).") and "\n" not in message
    assert not (tmp_path / "out.trc").exists()


def test_each_body_becomes_a_clip(recordings, tmp_path, capsys):
    """Who indexes again without the option keeps the clips of the bodies."""
    takes = [recordings / "kinect" / "irds" / f"215_18_{name}_stand.txt" for name in
             ("5_3_1", "5_8_1")]  # fmt: skip
    lines = [path.read_text().splitlines() for path in takes]
    merged = ["Version0.1"]
    for number, pair in enumerate(zip(*(each[1:] for each in lines), strict=False)):
        for body, line in enumerate(pair, start=7):
            _, _, _, joints = line.split(",", 3)
            merged.append(f"{number},{body},{33 * number},{joints}")
    (tmp_path / "duo.txt").write_text("\n".join(merged))
    library = str(tmp_path / "a.clips")

    assert main(["index", library, str(tmp_path / "duo.txt")]) == 0
    assert main(["index", library, str(tmp_path / "duo.txt"), "--body", "all", "--json"]) == 0
    first = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert main(["index", library, str(tmp_path / "duo.txt"), "--json"]) == 0
    again = json.loads(capsys.readouterr().out.splitlines()[-1])

    assert (first["added"], first["removed"]) == (["duo 7", "duo 8"], ["duo"])
    assert again["unchanged"] == ["duo 7", "duo 8"] and again["n_clips"] == 2
    words = ["find", str(tmp_path / "duo.txt"), library, "--body", "8", "--json"]
    assert main(words) == 0
    assert json.loads(capsys.readouterr().out)["matches"][0]["clip"] == "duo 8"


def test_equal_names_of_files_get_numbers():
    """Signs that no file name may have are replaced; the names of some disks have no case."""
    names = ["Anna:1", "Anna 1", "ANNA/1", "../Anna", "a" * 50 + "b", "a" * 50 + "c", "é"]

    made = tasks._file_names(names)

    assert made == ["Anna_1", "Anna_1_2", "ANNA_1_3", "___Anna", "a" * 40, "a" * 40 + "_2", "é"]


def test_no_body_is_written_to_the_recording(crowd, tmp_path, capsys):
    """The recording is named as the output of its second body would be."""
    recording = crowd.rename(tmp_path / "out_2.trc")
    before = recording.read_bytes()

    assert main(["convert", str(recording), str(tmp_path / "out.trc"), "--body", "all"]) != 0

    assert "would be overwritten" in capsys.readouterr().err
    assert recording.read_bytes() == before
