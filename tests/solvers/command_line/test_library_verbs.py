"""`index` makes libraries and `find` searches them; other verbs learn from them."""

import json
import shutil

import pytest

from solvers.recordings import read_bvh, write_bvh
from solvers.retrieval import load_clip_library, open_clip_library
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture(scope="module")
def walks(tmp_path_factory):
    """A folder of walks, slow and fast."""
    folder = tmp_path_factory.mktemp("walks")
    for cadence in (100, 120, 140):
        settings = GaitSettings(speed=0.9, cadence=cadence, duration=3.0, frame_rate=30.0)
        write_bvh(walking_gait(settings), folder / f"walk_{cadence}.bvh")
    return folder


@pytest.fixture
def library(call, walks, tmp_path):
    path = tmp_path / "library.clips"
    messages = call("index", path, walks, "--tag", "walk")
    assert messages == (0, f"3 added; {path} has 3 clips.\n", "")
    return path


def test_index_reports_its_work_and_does_it_once(call, walks, library):
    assert call("index", library, walks)[1] == f"3 unchanged; {library} has 3 clips.\n"
    status, printed, _ = call("index", library, walks, "--tag", "loud", "--json", "--jobs", 1)
    messages = json.loads(printed)
    assert status == 0
    assert messages["changed"] == ["walk_100", "walk_120", "walk_140"]
    assert (messages["n_clips"], messages["added"], messages["refused"]) == (3, [], [])
    assert messages["output"] == messages["library"] == str(library)


def test_index_reports_each_refused_file_and_fails(call, walks, library, tmp_path):
    shutil.copytree(walks, tmp_path / "more")
    (tmp_path / "more" / "broken.bvh").write_text("HIERARCHY\nROOT")
    (tmp_path / "more" / "walk_100.bvh").unlink()

    status, printed, failed = call("index", library, tmp_path / "more")

    assert status == 2
    assert printed == f"2 added, 1 refused; {library} has 5 clips.\n"
    assert failed.count("\n") == 1
    assert "broken.bvh" in failed


def test_index_removes_deleted_files(call, walks, tmp_path):
    folder = shutil.copytree(walks, tmp_path / "walks")
    path = tmp_path / "library.clips"
    call("index", path, folder)
    (folder / "walk_140.bvh").unlink()

    assert call("index", path, folder)[1].endswith("has 3 clips.\n")
    printed = call("index", path, folder, "--remove-missing")[1]
    assert printed == f"2 unchanged, 1 removed; {path} has 2 clips.\n"


def test_find_prints_a_table_best_first(call, walks, library):
    status, printed, _ = call("find", walks / "walk_140.bvh", library, "--n-neighbors", 0)
    header, *rows = printed.splitlines()
    assert status == 0
    assert header.split() == ["clip", "score", "frames", "seconds", "tags"]
    name, score, frames, _, tags = rows[0].split()
    assert (name, frames, tags) == ("walk_140", "1-90", "walk")
    assert float(score) > 0.95
    assert len(rows) == 3


def test_find_searches_with_frames_and_parts_of_the_body(call, walks, library):
    words = ("find", walks / "walk_100.bvh", library, "--json", "--n-neighbors", 0)
    messages = json.loads(call(*words, "--frames", "30:60", "--no-left-arm")[1])
    best = messages["matches"][0]
    assert best["clip"] == "walk_100"
    assert abs(best["first_frame"] - 30) < 5
    assert abs(best["last_frame"] - 59) < 5
    assert best["path"] == str((walks / "walk_100.bvh").resolve())
    ignored = json.loads(call(*words, "--ignore", "walk_100", "--n-matches", 1)[1])
    assert [match["clip"] for match in ignored["matches"]] != ["walk_100"]
    assert len(ignored["matches"]) == 1


def test_libraries_of_one_vocabulary_are_searched_together(call, walks, library, tmp_path):
    shards, query = tmp_path / "shards", walks / "walk_140.bvh"
    shards.mkdir()
    for name in ("walk_100", "walk_120", "walk_140"):
        words = (shards / f"{name}.clips", walks / f"{name}.bvh", "--vocabulary", library)
        assert call("index", *words)[0] == 0
    words = (shards / "walk_100.clips", walks / "walk_100.bvh")
    assert "1 unchanged" in call("index", *words, "--vocabulary", words[0])[1]

    together = json.loads(call("find", query, shards, "--json")[1])["matches"]
    one = json.loads(call("find", query, library, "--json")[1])["matches"]
    for each in together:
        assert each.pop("library") == str(shards / f"{each['clip']}.clips")
        assert not each.pop("tags")
    assert [each["clip"] for each in together] == [each["clip"] for each in one]
    for each, other in zip(together, one, strict=True):
        assert (other.pop("library"), other.pop("tags")) == (str(library), ["walk"])
        assert each.pop("score") == pytest.approx(other.pop("score"), abs=1e-5)
        assert each == other

    status, printed, _ = call("find", query, shards, library)
    assert status == 0
    assert printed.splitlines()[0].split()[:3] == ["clip", "library", "score"]
    assert len(printed.splitlines()) == 1 + 3 + 3

    call("index", tmp_path / "other.clips", query)
    status, _, failed = call("find", query, library, tmp_path / "other.clips")
    assert (status, failed.count("\n")) == (2, 1)
    assert "have different vocabularies, so their clips cannot be ranked" in failed


def test_wrong_library_arguments_are_reported_in_one_sentence(call, walks, library, tmp_path):
    query, none = walks / "walk_100.bvh", tmp_path / "none"
    (tmp_path / "empty").touch()
    new = tmp_path / "new" / "new.clips"
    new.parent.mkdir()
    open_clip_library(new).close()
    open_clip_library(new.with_name("too.clips")).close()
    limbs = ("left-arm", "right-arm", "left-leg", "right-leg")
    parts = [f"--no-{part}" for part in ("trunk", *limbs)]
    for words, sentence in (
        (("find", query), "walk_100.bvh is named: name the recording and then one or more lib"),
        (("find", query, none), "There is no clip library"),
        (("find", query, query), "is not a clip library"),
        (("find", query, tmp_path / "empty"), "is not a clip library"),
        (("find", none, library), "There is no file"),
        (("find", query, library, "--frames", "90:"), "90 frames; the range from 90 is empty"),
        (("find", query, library, *parts), "No part of the body is chosen"),
        (("index", library, walks, "--vocabulary", none), "There is no clip library"),
        (("index", none, walks, "--vocabulary", new), "has no clips, and so no vocabulary."),
        (("find", query, new, new.parent), "The libraries have no clips; index some first."),
        (("index", library), "name the library and then recordings"),
        (("index", library, none), "There is no file or folder"),
        (("index", none / "a.clips", walks), "cannot be used"),
        (("index", tmp_path / "a.bat", walks), "end its name in .clips."),
        (("index", library, walks, "--tag", "a\nb"), r"The tag 'a\nb' has control characters."),
        (
            ("denoise", query, tmp_path / "a.bvh", "--library", none),
            "There is no clip library",
        ),
        (("reconstruct", query, tmp_path / "a.bvh", "--library", none), "no clip library"),
    ):
        status, _, failed = call(*words)
        assert status == 2
        assert sentence in failed, words
        assert failed.count("\n") == 1


@pytest.mark.parametrize("verb", ["denoise", "reconstruct"])
def test_denoise_learns_from_similar_clips_except_its_own_take(
    call, walks, library, tmp_path, verb
):
    target = tmp_path / "clean.bvh"
    status, printed, failed = call(verb, walks / "walk_120.bvh", target, "--library", library)

    assert (status, failed) == (0, "")
    first = next(line for line in printed.splitlines() if line.startswith("Learned from"))
    assert first.startswith("Learned from 2 clips of the library: walk_1")
    assert "walk_120" not in first
    assert read_bvh(target).n_frames == 90


def test_a_library_without_clips_is_refused(call, walks, tmp_path):
    open_clip_library(tmp_path / "new.clips").close()
    words = ("denoise", walks / "walk_100.bvh", tmp_path / "a.bvh", "--library")
    assert "has no clips; index some first" in call(*words, tmp_path / "new.clips")[2]
    words = ("find", walks / "walk_100.bvh", tmp_path / "new.clips")
    assert "index some first" in call(*words)[2]
    assert not load_clip_library(tmp_path / "new.clips").entries
