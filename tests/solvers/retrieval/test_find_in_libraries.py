"""Libraries with one vocabulary are searched as if they were one library."""

from itertools import pairwise

import numpy as np
import pytest
from acted_clips import ACTS, act

from solvers.errors import InvalidFileError, InvalidMotionError, InvalidSettingError
from solvers.recordings import read_tracked
from solvers.retrieval import (
    Clip,
    FindMethod,
    FindSettings,
    find_in_libraries,
    find_similar,
    libraries_in,
    load_clip_library,
    open_clip_library,
)
from solvers.retrieval.index import vocabulary as words

N_SHARDS = 3
SETTINGS = {
    "ten": FindSettings(n_matches=10),
    "all": FindSettings(),
    "more than are warped": FindSettings(n_matches=9, n_warped=4),
    "one arm": FindSettings(left_arm=False, n_neighbors=2),
    "no neighbors": FindSettings(n_neighbors=0, n_aligned=3),
}


def fill(path, clips, vocabulary):
    with open_clip_library(path) as library:
        library.freeze_vocabulary(vocabulary)
        library.add(clips)
    return path


@pytest.fixture(scope="module")
def real_clips(recordings):
    """Quarters of takes of two actors, and of walks."""
    mocap = recordings / "mocap"
    files = [
        *sorted(mocap.glob("hdm05/*.amc"))[::15],
        *sorted(mocap.glob("cmu_walk/*.bvh"))[::9],
    ]
    found = []
    for path in files:
        take = read_tracked(path)
        bounds = np.linspace(0, take.n_frames, 5).astype(int)
        for number, (start, stop) in enumerate(pairwise(bounds)):
            found.append(Clip(f"{path.stem} {number}", take.slice(start, stop)))
    return found


@pytest.fixture(scope="module")
def real_libraries(real_clips, tmp_path_factory):
    """One library with all clips, and three with a third of them, of one vocabulary."""
    folder = tmp_path_factory.mktemp("libraries")
    with open_clip_library(folder / "first.clips") as first:
        first.add(real_clips[::4])
        vocabulary = first.vocabulary
    bounds = np.linspace(0, len(real_clips), N_SHARDS + 1).astype(int)
    shards = [
        fill(folder / f"shard{number}.clips", real_clips[start:stop], vocabulary)
        for number, (start, stop) in enumerate(pairwise(bounds))
    ]
    return fill(folder / "whole.clips", real_clips, vocabulary), shards


@pytest.mark.parametrize("requested", SETTINGS)
def test_shards_rank_real_clips_as_one_library_does(real_clips, real_libraries, requested):
    complete, shards = real_libraries
    for query in real_clips[2::25]:
        ignored = (real_clips[0].name,)
        settings = SETTINGS[requested]

        with load_clip_library(complete) as library:
            expected = find_similar(query.recording, library, settings=settings, ignore=ignored)
        one = find_in_libraries(query.recording, [complete], settings=settings, ignore=ignored)
        found = find_in_libraries(query.recording, shards, settings=settings, ignore=ignored)

        assert [each.match.clip for each in one] == [each.clip for each in expected]
        assert len(found) == (settings.n_matches or len(real_clips) - 1)
        for each, other in zip(found, expected, strict=True):
            assert each.match.clip == each.entry.name == other.clip
            assert each.match.frames == other.frames
            assert each.match.score == pytest.approx(other.score, abs=1e-5)
            assert (each.match.alignment is None) == (other.alignment is None)
            if other.alignment is not None:
                np.testing.assert_array_equal(each.match.alignment, other.alignment)
            with load_clip_library(each.library) as home:
                assert home.numbers_of([other.clip])


@pytest.fixture
def acted(tmp_path):
    """A library of each act, with the vocabulary of the first, and clips of equal names."""
    with open_clip_library(tmp_path / "first.clips") as first:
        first.add([Clip(name, act(name)) for name in ACTS])
        vocabulary = first.vocabulary
    folder = tmp_path / "shards"
    folder.mkdir()
    for name in ACTS:
        fill(folder / f"{name}.clips", [Clip("clip", act(name, 1.6))], vocabulary)
    return folder


def test_clips_of_equal_names_are_distinguished_by_their_libraries(acted):
    found = find_in_libraries(act("kick", 1.8), libraries_in([acted]))
    assert found[0].library == acted / "kick.clips"
    assert {each.match.clip for each in found} == {"clip"}
    assert {each.library.stem for each in found} == set(ACTS)


def test_folders_and_libraries_are_listed_once(acted, tmp_path):
    assert libraries_in([acted / "wave.clips", acted]) == [
        acted / f"{name}.clips" for name in ("wave", "bow", "kick", "squat", "step")
    ]
    (tmp_path / "none").mkdir()
    with pytest.raises(InvalidFileError, match="There is no clip library in the folder"):
        libraries_in([tmp_path / "none"])


def test_libraries_without_clips_are_skipped(acted, tmp_path):
    open_clip_library(tmp_path / "empty.clips").close()
    empty = [tmp_path / "empty.clips"]
    found = find_in_libraries(act("bow"), [*empty, *libraries_in([acted])])
    assert found[0].library == acted / "bow.clips"
    assert find_in_libraries(act("bow"), empty * 2) == ()


def test_libraries_with_different_vocabularies_are_refused(acted, tmp_path):
    other = tmp_path / "other.clips"
    with open_clip_library(other) as library:
        library.add([Clip("wave", act("wave"))])
    paths = [acted / "kick.clips", other]

    with pytest.raises(InvalidSettingError) as refused:
        find_in_libraries(act("kick"), paths)
    assert str(refused.value) == (
        f"{paths[0]} and {other} have different vocabularies, so their clips cannot be ranked"
        f" together. Index {other} again with --vocabulary {paths[0]}."
    )

    with load_clip_library(paths[0]) as frozen, load_clip_library(other) as library:
        library.freeze_vocabulary(frozen.vocabulary)
    assert len(find_in_libraries(act("kick"), paths)) == 2


def test_published_method_searches_one_library(acted):
    settings, one = FindSettings(method=FindMethod.PUBLISHED), acted / "bow.clips"
    with pytest.raises(InvalidMotionError, match="atoms"):
        find_in_libraries(act("kick"), [one], settings=settings)
    with pytest.raises(InvalidSettingError, match="searches only one library"):
        find_in_libraries(act("kick"), [one, acted / "kick.clips"], settings=settings)


def test_frozen_vocabulary_is_never_learned_again(tmp_path, monkeypatch):
    monkeypatch.setattr(words, "RELEARNING_RATIO", 1)
    clips = [Clip(name, act(name)) for name in ACTS]
    kept = {}
    for name in ("free", "frozen"):
        with open_clip_library(tmp_path / f"{name}.clips") as library:
            library.add(clips[:1])
            if name == "frozen":
                library.freeze_vocabulary(library.vocabulary)
            before = library.vocabulary
        with load_clip_library(tmp_path / f"{name}.clips") as library:
            library.add(clips[1:])
            kept[name] = library.vocabulary.describes_like(before)
    assert kept == {"free": False, "frozen": True}


def test_clips_are_indexed_again_with_another_vocabulary(acted, tmp_path):
    clips = [Clip(name, act(name)) for name in ACTS]
    with load_clip_library(acted / "bow.clips") as library:
        vocabulary = library.vocabulary
    fill(tmp_path / "fresh.clips", clips, vocabulary)
    with open_clip_library(tmp_path / "later.clips") as later:
        later.add([Clip("long", act("bow", 3.0))])
        later.add(clips)
        later.remove(["long"])
        later.freeze_vocabulary(vocabulary)
        with load_clip_library(tmp_path / "fresh.clips") as fresh:
            (one, _), (two, _) = *later.blocks, *fresh.blocks
        assert later.vocabulary.is_frozen
        np.testing.assert_array_equal(one.histograms, two.histograms)
