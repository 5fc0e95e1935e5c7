"""Two processes may index into one library at once; odd names keep no other file out."""

from pathlib import Path

import pytest

from solvers.errors import InvalidMotionError
from solvers.recordings import write_bvh
from solvers.retrieval import load_clip_library
from solvers.samples import GaitSettings, walking_gait
from solvers.workflows import index_files


@pytest.fixture
def folders(tmp_path):
    """Two folders of walks with the same names, all different."""
    found = []
    for position in ("first", "second"):
        folder = tmp_path / position / "takes"
        folder.mkdir(parents=True)
        for number in range(3):
            cadence = 90 + 10 * number + len(position)
            walk = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0, cadence=cadence))
            write_bvh(walk, folder / f"t{number}.bvh")
        found.append(folder)
    return found


@pytest.fixture
def library(tmp_path):
    return tmp_path / "a.clips"


def paths_of(library):
    with load_clip_library(library) as opened:
        return {entry.name: Path(entry.origin.path) for entry in opened.entries}


def once(work):
    """A Progress that does something else the first time that it is called."""
    left = [work]

    def progress(fraction, message=""):
        if left:
            left.pop()()

    return progress


def test_parallel_indexing_keeps_clips_of_the_same_names(folders, library):
    first, second = folders
    meanwhile = []

    report = index_files(
        library,
        [first],
        progress=once(lambda: meanwhile.append(index_files(library, [second]))),
    )

    assert meanwhile[0].added == ("t0", "t1", "t2")
    assert report.added == ("t0.bvh", "t1.bvh", "t2.bvh")
    assert sorted(paths_of(library).values()) == [
        folder / f"t{number}.bvh" for folder in folders for number in range(3)
    ]
    assert len(index_files(library, folders).unchanged) == 6


def test_no_clip_is_duplicated_when_another_process_indexes_the_same_files(folders, library):
    first, _ = folders

    index_files(library, [first], progress=once(lambda: index_files(library, [first.parent])))

    assert paths_of(library) == {f"takes/t{n}": first / f"t{n}.bvh" for n in range(3)}


def test_clip_of_another_process_stays_when_its_file_is_refused(folders, library):
    """Its name may be that of another file by now."""
    first, second = folders
    index_files(library, [first])
    (first / "t0.bvh").write_text("HIERARCHY\nROOT")

    def take_its_name():
        (first / "t0.bvh").rename(first / "t0.txt")
        index_files(library, [first], remove_missing=True)
        index_files(library, [second / "t0.bvh"])
        (first / "t0.txt").rename(first / "t0.bvh")

    index_files(library, [first], progress=once(take_its_name))

    assert paths_of(library)["t0"] == second / "t0.bvh"
    assert len(paths_of(library)) == 3


def test_invalid_file_names_are_refused_and_others_become_clips(folders, library):
    first, _ = folders
    (first / "t1.bvh").rename(first / "line\nbreak.bvh")
    odd = first / "caf\udce9"
    try:
        odd.mkdir()
    except OSError:
        pytest.skip("this system has no names that are no UTF-8")
    (first / "t2.bvh").rename(odd / "t2.bvh")

    for _ in range(2):
        report = index_files(library, [first])
        sentences = sorted(sentence for _, sentence in report.refused)
        assert report.n_clips == 1
        assert len(sentences) == 2 and all(each.isprintable() for each in sentences)
        assert r"caf\udce9/t2.bvh' is not valid UTF-8; rename the file or" in sentences[0]
        assert r"line\nbreak.bvh' has control characters; rename the file or" in sentences[1]


def test_invalid_tag_is_refused_before_the_work(folders, library):
    with pytest.raises(InvalidMotionError, match=r"'a\\tb' has control characters"):
        index_files(library, folders, tags=["fine", "a\tb"])
    assert not library.exists()
