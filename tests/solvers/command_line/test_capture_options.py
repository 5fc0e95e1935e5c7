"""Options of `capture` that contradict each other, and files that it must not replace."""

import numpy as np
import pytest
from depth_files import depth_npz

from solvers.command_line.batches import left_of_earlier_run
from solvers.command_line.sharing import Record, Records


@pytest.fixture
def take(tmp_path):
    path = tmp_path / "two.npz"
    path.write_bytes(depth_npz(np.full((4, 6, 8), 4000, np.uint16), frame_rate=30.0))
    return path


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--max-delay", "0"), "--max-delay has no effect without --follow. Leave it out."),
        (("--max-offset", "9"), "--max-offset has no effect without --camera."),
        (("--no-feet", "--no-move-root"), "--no-move-root has no effect with --no-feet."),
        (("--follow", "--smoothing", "2"), "--smoothing has no effect with --follow."),
        (("--method", "wei", "--backward"), "--backward has no effect with --method wei."),
        (("--joints",), "--joints has no effect without --output-folder."),
        (("--people", "all", "--method", "lou"), "The method lou tracks one person in the"),
        (("--people", "2", "--body", "a.npz"), "A body file holds one body. Leave out --body"),
        (("--people", "all", "--keep-body", "a.npz"), "A body file holds one body."),
    ],
)
def test_options_without_effect_are_refused(call, take, tmp_path, words, sentence):
    status, out, err = call("capture", take, tmp_path / "out.bvh", *words)

    assert (status, out) == (2, "") and sentence in err and err.count("\n") == 1
    assert not (tmp_path / "out.bvh").exists()


def test_options_that_agree_with_following_are_no_contradiction(call, tmp_path):
    """Nothing is there to be followed, which is what the sentence says."""
    words = ("--no-backward", "--smoothing", "0", "--max-wait", "0.5")

    _, _, err = call("capture", tmp_path / "none.mkv", tmp_path / "out.bvh", "--follow", *words)

    assert "has no effect" not in err and "none.mkv" in err


def test_file_that_was_not_named_is_not_replaced_by_a_person(call, take, tmp_path):
    precious = tmp_path / "out_person2.bvh"
    precious.write_text("precious")
    words = ("capture", take, tmp_path / "out.bvh", "--people", "2")

    status, _, err = call(*words)

    assert status == 2 and f"{precious} exists, and would be replaced by a person" in err
    (tmp_path / "out.bvh").write_text("of an earlier run")
    assert "would be replaced" not in call(*words)[2]  # but that no person is visible
    assert precious.read_text() == "precious"
    precious.unlink()
    precious.mkdir()
    assert "it is a folder" in call(*words)[2]


def test_result_of_another_take_is_not_replaced_by_a_person(call, take, tmp_path):
    folder = tmp_path / "out"
    folder.mkdir()
    other = folder / "two_person2.bvh"
    other.write_text("the only person of another take")
    words = ("capture", take, "--output-folder", folder, "--people", "all")

    _, _, err = call(*words)

    assert "would be replaced" not in err  # left by a run that was killed
    records = Records(folder)
    records.prepare()
    given = ["two_person2.npz"]
    records.write(Record(verb="capture", inputs=given, output=other.name, fingerprint={}))
    status, _, err = call(*words)
    assert status == 2 and f"{other} is the result of two_person2.npz" in err
    assert other.read_text() == "the only person of another take"


def test_take_does_not_replace_a_person_of_another_take(call, take, tmp_path):
    folder, person = tmp_path / "out", tmp_path / "two_person2.npz"
    person.write_bytes(take.read_bytes())
    records = Records(folder)
    records.prepare()
    (folder / "two_person2.bvh").write_text("the second person of two")
    people = [{"output": f"Z:\\\\out\\\\{name}"} for name in ("two.bvh", "two_person2.bvh")]
    given = {"verb": "capture", "inputs": [], "output": "two.bvh", "fingerprint": {}}
    records.write(Record(**given, figures={"people": people}))
    words = ("capture", person, "--output-folder", folder)

    status, _, err = call(*words)

    assert status == 2 and "two_person2.bvh is a person of two.bvh, and would be" in err
    assert (folder / "two_person2.bvh").read_text() == "the second person of two"
    records.write(Record(**given, figures={"people": people[:1]}))
    assert "is a person of" not in call(*words)[2]


def test_only_names_that_people_get_are_files_of_people(call, take, tmp_path):
    for name in ("_person1", "_person02", "_person3", "_person2_person2"):
        (tmp_path / f"out{name}.bvh").write_text("precious")

    _, _, err = call("capture", take, tmp_path / "out.bvh", "--people", "2")

    assert "would be replaced" not in err  # but that no person is visible


def test_people_that_this_run_has_not_found_are_listed(tmp_path):
    for name in ("a*", "a*_person2", "a*_person3", "a*_person1", "ab_person3"):
        (tmp_path / f"{name}.bvh").touch()
    (tmp_path / "a*_person3.csv").touch()

    assert left_of_earlier_run(tmp_path / "a*.bvh", 2) == [tmp_path / "a*_person3.bvh"]
