"""A library follows its files: new, changed, deleted or refused ones."""

import os
import shutil
import sqlite3
import sys
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from solvers.errors import InvalidFileError, SolveCancelled
from solvers.motion import Tracks
from solvers.recordings import write_bvh, write_trc
from solvers.retrieval import FindSettings, find_similar, load_clip_library
from solvers.samples import GaitSettings, walking_gait
from solvers.workflows import describe_files, index_files

indexing = sys.modules["solvers.workflows.index_files"]
"""The module; under its name the package has the verb."""


def walk(cadence: float = 110.0, duration: float = 1.0):
    return walking_gait(
        GaitSettings(speed=0.9, cadence=cadence, duration=duration, frame_rate=30.0)
    )


@pytest.fixture
def folder(tmp_path):
    """Two folders of walks, and markers that are no body."""
    for position, cadence in (("a/slow", 80), ("a/fast", 140), ("b/slow", 90)):
        path = tmp_path / "clips" / f"{position}.bvh"
        path.parent.mkdir(parents=True, exist_ok=True)
        write_bvh(walk(cadence), path)
    markers = Tracks(("m1", "m2"), np.ones((9, 2, 3)), 30.0)
    write_trc(markers, tmp_path / "clips" / "markers.trc")
    (tmp_path / "clips" / "notes.txt").write_text("not a recording")
    return tmp_path / "clips"


@pytest.fixture
def library(tmp_path):
    return tmp_path / "library.clips"


def entries(path):
    with load_clip_library(path) as library:
        return {entry.name: entry for entry in library.entries}


def test_folder_becomes_clips_named_by_their_paths(folder, library):
    report = index_files(library, [folder], tags=["walk", "walk"])

    assert report.added == ("a/fast", "a/slow", "b/slow")
    assert report.n_clips == 3
    ((path, sentence),) = report.refused
    assert path == str(folder / "markers.trc")
    assert "markers.trc: No body was recognized" in sentence
    found = entries(library)
    stat = (folder / "a" / "fast.bvh").stat()
    origin = found["a/fast"].origin
    assert origin.path == str(folder.resolve() / "a" / "fast.bvh")
    assert (origin.item, origin.size, origin.modified) == ("", stat.st_size, stat.st_mtime_ns)
    assert found["a/fast"].tags == ("walk",)
    with load_clip_library(library) as opened:
        best = find_similar(walk(140), opened, settings=FindSettings(n_neighbors=0))[0]
    assert best.clip == "a/fast"


def test_unchanged_files_are_not_read_again(folder, library, monkeypatch):
    index_files(library, [folder])
    (folder / "markers.trc").unlink()
    monkeypatch.setattr(describe_files, "read_tracked", None)

    report = index_files(library, [folder])

    assert report.unchanged == ("a/fast", "a/slow", "b/slow")
    assert not (report.added or report.changed or report.removed or report.refused)


def test_refused_files_are_not_read_again_until_they_change(folder, library, monkeypatch):
    first = index_files(library, [folder])
    read, tried = describe_files.read_tracked, []

    def reading(path, **body):
        tried.append(path)
        return read(path, **body)

    monkeypatch.setattr(describe_files, "read_tracked", reading)

    again = index_files(library, [folder])
    assert again.refused == first.refused
    assert not tried

    write_bvh(walk(100), folder / "markers.trc")  # formats are recognized by content
    assert index_files(library, [folder]).added == ("markers",)
    assert len(tried) == 1


def test_files_refused_by_another_version_are_read_again(folder, library, monkeypatch):
    index_files(library, [folder])
    monkeypatch.setattr(indexing, "version", lambda: "later")
    monkeypatch.setattr(describe_files, "read_tracked", lambda path, **body: walk())
    assert index_files(library, [folder / "markers.trc"]).n_clips == 4


def test_files_refused_for_memory_are_read_again(folder, library, monkeypatch):
    def too_large(path, **body):
        raise MemoryError

    with monkeypatch.context() as patched:
        patched.setattr(describe_files, "read_tracked", too_large)
        assert len(index_files(library, [folder / "a"]).refused) == 2
    assert index_files(library, [folder / "a"]).added == ("fast", "slow")


def test_library_without_stored_refusals_is_used(folder, library):
    index_files(library, [folder / "a"])
    with closing(sqlite3.connect(library)) as database, database:
        database.execute("DROP TABLE IF EXISTS refused")
    assert len(index_files(library, [folder]).refused) == 1
    assert len(index_files(library, [folder]).refused) == 1


def test_amc_file_counts_as_changed_with_its_skeleton(tmp_path, library, recordings):
    mocap = recordings / "mocap"
    for name in ("05.asf", "05_13.amc"):
        shutil.copy(mocap / name, tmp_path / name)
    clip = tmp_path / "05_13.amc"
    assert index_files(library, [clip]).n_clips == 1
    assert len(index_files(library, [clip]).unchanged) == 1

    text = (tmp_path / "05.asf").read_text()
    (tmp_path / "05.asf").write_text(text + "\n")
    assert index_files(library, [clip]).changed == ("05_13",)

    (tmp_path / "05.asf").unlink()
    assert "There is no skeleton" in index_files(library, [clip]).refused[0][1]
    (tmp_path / "05.asf").write_text(text)
    assert index_files(library, [clip]).added == ("05_13",)


def test_changed_file_is_read_again_under_its_name(folder, library):
    index_files(library, [folder])
    write_bvh(walk(70, duration=2.0), folder / "a" / "fast.bvh")
    moved = (folder / "a" / "slow.bvh").stat().st_mtime_ns + 10**9
    os.utime(folder / "a" / "slow.bvh", ns=(moved, moved))

    report = index_files(library, [folder / "a"])

    assert report.changed == ("a/fast", "a/slow")
    assert report.n_clips == 3
    assert entries(library)["a/fast"].n_frames == 60


def test_tags_are_added_and_persist(folder, library):
    index_files(library, [folder], tags=["walk"])
    assert index_files(library, [folder / "a"], tags=["loud"]).changed == ("a/fast", "a/slow")
    assert len(index_files(library, [folder]).unchanged) == 3

    found = entries(library)
    assert found["a/fast"].tags == ("walk", "loud")
    assert found["b/slow"].tags == ("walk",)


def test_clip_stays_when_its_file_is_hidden_but_not_gone(folder, library):
    """A drive may be away for a while; for root, too, a link to itself is such a file."""
    index_files(library, [folder])
    fast = folder / "a" / "fast.bvh"
    fast.unlink()
    fast.symlink_to(fast)

    report = index_files(library, [folder], remove_missing=True)

    assert (report.removed, report.n_clips) == ((), 3)


def test_clips_of_deleted_files_are_removed_on_request(folder, library):
    index_files(library, [folder])
    (folder / "a" / "fast.bvh").unlink()
    shutil.rmtree(folder / "b")

    assert index_files(library, [folder]).n_clips == 3
    inside = index_files(library, [folder / "a"], remove_missing=True)
    assert (inside.removed, inside.n_clips) == (("a/fast",), 2)
    assert index_files(library, [folder], remove_missing=True).removed == ("b/slow",)
    with load_clip_library(library) as opened:
        assert [match.clip for match in find_similar(walk(), opened)] == ["a/slow"]


def test_clip_of_a_file_damaged_later_is_removed(folder, library):
    index_files(library, [folder])
    (folder / "a" / "fast.bvh").write_text("HIERARCHY\nROOT")

    report = index_files(library, [folder])

    assert report.removed == ("a/fast",)
    assert {Path(path).name for path, _ in report.refused} == {"fast.bvh", "markers.trc"}
    assert "a/fast" not in entries(library)


def test_clips_of_the_same_name_become_unique(folder, library):
    shutil.copytree(folder / "a", folder.parent / "other")
    shutil.copy(folder / "a" / "slow.bvh", folder.parent / "slow.bvh")
    (folder / "a" / "slow.BVH").write_bytes((folder / "a" / "slow.bvh").read_bytes())

    index_files(library, [folder / "a"])
    index_files(library, [folder.parent / "other"])
    report = index_files(library, [folder.parent / "slow.bvh", folder / "a" / "slow.bvh"])

    assert len(report.unchanged) == 1
    names = set(entries(library))
    assert len(names) == 6
    assert {"fast", "slow", "fast.bvh", "slow.bvh"} <= names


def test_file_listed_twice_is_one_clip(folder, library):
    report = index_files(library, [folder / "a", folder, folder / "a" / "slow.bvh"])
    assert report.added == ("fast", "slow", "b/slow")


def test_parallel_processes_make_the_same_library(folder, tmp_path):
    alone, together = tmp_path / "1.clips", tmp_path / "2.clips"
    first = index_files(alone, [folder])
    assert index_files(together, [folder], jobs=2) == first
    assert entries(alone) == entries(together)


def test_interrupt_loses_at_most_one_batch(folder, library, monkeypatch):
    monkeypatch.setattr(indexing, "MAX_BATCH_CLIPS", 2)
    for number in range(5):
        write_bvh(walk(100 + number), folder / f"{number}.bvh")

    def cancel(fraction, message=""):
        if message == "4.bvh":
            raise SolveCancelled

    with pytest.raises(SolveCancelled):
        index_files(library, [folder], progress=cancel)
    assert len(entries(library)) == 4
    rest = index_files(library, [folder])
    assert (len(rest.unchanged), rest.n_clips) == (4, 8)


def test_long_takes_are_written_in_smaller_batches(folder, library, monkeypatch):
    monkeypatch.setattr(indexing, "MAX_BATCH_FRAMES", 30)
    written = []
    monkeypatch.setattr(
        "solvers.retrieval.ClipLibrary.add_described",
        lambda self, clips, **_: written.append(len(clips)) or [""] * len(clips),
    )
    index_files(library, [folder])
    assert written == [2, 1]


def test_progress_rises_to_one(folder, library):
    messages = []
    index_files(
        library, [folder], progress=lambda fraction, message="": messages.append(fraction)
    )
    assert messages == sorted(messages)
    assert (messages[0], messages[-1]) == (0.0, 1.0)


def test_missing_source_is_refused_before_the_work(folder, library, tmp_path):
    with pytest.raises(InvalidFileError, match="There is no file or folder"):
        index_files(library, [folder, tmp_path / "none"])
    assert not library.exists()
    library.write_text("no library at all, though long enough to be something else")
    with pytest.raises(InvalidFileError, match="not a clip library"):
        index_files(library, [folder])


def test_indexed_sources_can_be_deleted(folder, library):
    index_files(library, [folder])
    shutil.rmtree(folder)
    with load_clip_library(library) as opened:
        assert len(find_similar(walk(80), opened)) == 3


def test_one_library_can_hold_any_rigs(recordings, library):
    """BVH of CMU and AMC of HDM05 and what a Kinect saw: a squat finds squats."""
    hdm05 = recordings / "mocap" / "hdm05"
    squats = sorted(hdm05.glob("HDM_bd_squat1Reps_*.amc"))[:3]
    kicks = sorted(hdm05.glob("HDM_bd_kickLFront1Reps_*.amc"))[:3]
    walks = sorted((recordings / "mocap" / "cmu_walk").glob("35_0*.bvh"))[:3]
    deep_squats = sorted((recordings / "kinect" / "ui_prmd").glob("m01_s01_e*.npz"))[:3]

    report = index_files(library, [*squats, *kicks, *walks, *deep_squats])

    assert (report.n_clips, report.refused) == (12, ())
    query = describe_files.read_tracked(deep_squats[0])
    with load_clip_library(library) as opened:
        found = [m.clip for m in find_similar(query, opened, ignore=[deep_squats[0].stem])]
    assert set(found[:5]) == {path.stem for path in (*squats, *deep_squats[1:])}
