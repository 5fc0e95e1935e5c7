"""A library holds the clips that were added and not removed, by any sequence of changes."""

from dataclasses import replace

import numpy as np
import pytest
from acted_clips import ACTS, act
from numpy.testing import assert_array_equal

from solvers.errors import InvalidMotionError, SolveCancelled
from solvers.motion import Tracks
from solvers.retrieval import (
    Clip,
    ClipLibrary,
    FindSettings,
    Origin,
    build_clip_library,
    describe_clip,
    find_similar,
    load_clip_library,
    open_clip_library,
)
from solvers.retrieval.library import index_clips

SPEEDS = (1.6, 2.0, 2.4, 2.8)


def clips(names=ACTS, speeds=SPEEDS) -> list[Clip]:
    return [
        Clip(f"{name} {seconds}", act(name, seconds, amount=0.7 + 0.1 * seconds), (name,))
        for name in names
        for seconds in speeds
    ]


def ranking(library: ClipLibrary, query: Tracks | None = None) -> list[tuple]:
    found = find_similar(act("kick", 2.2) if query is None else query, library)
    return [(match.clip, match.frames, match.score) for match in found]


def names(library: ClipLibrary) -> list[str]:
    return [entry.name for entry in library.entries]


def test_entries_describe_the_added_clips():
    origin = Origin("/clips/a.blend", "Wave", 12, 34)
    library = build_clip_library([Clip("a", act("wave", 2.0, 50.0), ("x", "é"), origin)])

    (entry,) = library.entries
    assert (entry.name, entry.tags, entry.origin) == ("a", ("x", "é"), origin)
    assert (entry.n_frames, entry.frame_rate, entry.seconds) == (100, 50.0, 2.0)


def test_removed_clips_leave_no_trace():
    """The vocabulary that was learned with them remains."""
    library = build_clip_library(clips())
    before = ranking(library)
    library.add(clips(speeds=(1.8,)))
    assert ranking(library) != before

    library.remove([f"{name} 1.8" for name in ACTS])

    assert ranking(library) == before
    assert len(library.entries) == len(ACTS) * len(SPEEDS)


def test_ranking_does_not_depend_on_the_order_of_additions():
    first, *rest = (clips(speeds=(seconds,)) for seconds in (*SPEEDS, 3.2))
    in_parts, at_once = build_clip_library(first), build_clip_library(first)
    assert in_parts.vocabulary is not None

    for part in rest[:2]:
        in_parts.add(part)
    at_once.add([clip for part in rest[:2] for clip in part])

    assert_array_equal(in_parts.vocabulary.words, at_once.vocabulary.words)
    assert [match[:2] for match in ranking(in_parts)] == [m[:2] for m in ranking(at_once)]
    scores = ([match[2] for match in ranking(one)] for one in (in_parts, at_once))
    np.testing.assert_allclose(*scores, rtol=1e-6)


def test_grown_library_learns_a_new_vocabulary():
    grown = build_clip_library(clips(speeds=(2.0,)))
    grown.add(clips(speeds=(1.6, 1.8, 2.2, 2.4, 2.6)))

    built = build_clip_library(clips(speeds=(2.0, 1.6, 1.8, 2.2, 2.4, 2.6)))

    # Postures are stored as half floats, of which the words of the grown one were learned.
    np.testing.assert_allclose(grown.vocabulary.center, built.vocabulary.center, atol=1e-3)
    best = ({match[0] for match in ranking(library)[:6]} for library in (grown, built))
    assert [*best] == [{f"kick {seconds}" for seconds in (1.6, 1.8, 2.0, 2.2, 2.4, 2.6)}] * 2


def test_clip_with_the_same_name_replaces_the_previous_one():
    library = build_clip_library(clips())
    library.add([Clip("wave 2.0", act("squat", 2.0))])

    assert len(library.entries) == len(ACTS) * len(SPEEDS)
    best = [match[0] for match in ranking(library, act("squat"))[:5]]
    assert "wave 2.0" in best
    assert "wave 2.0" not in [match[0] for match in ranking(library, act("wave"))[:3]]


def test_small_blocks_rank_like_a_single_one(monkeypatch):
    one = build_clip_library(clips(speeds=(2.0,)))
    one.add(clips())
    monkeypatch.setattr(index_clips, "MAX_BLOCK_SEGMENTS", 3)
    many = build_clip_library(clips(speeds=(2.0,)))
    many.add(clips())

    assert len(many.blocks) > len(one.blocks) >= 1
    assert max(block.n_segments for block, _ in many.blocks) <= 20
    assert [match[0] for match in ranking(many)] == [match[0] for match in ranking(one)]


def test_clips_described_in_advance_rank_the_same():
    here, elsewhere = build_clip_library(clips()), build_clip_library([])
    elsewhere.add_described([describe_clip(clip) for clip in clips()])

    assert ranking(here) == ranking(elsewhere)


def test_empty_library_finds_nothing_and_can_be_filled(tmp_path):
    for library in (build_clip_library([]), open_clip_library(tmp_path / "new.clips")):
        assert library.entries == ()
        assert library.vocabulary is None
        assert find_similar(act("wave"), library) == ()
        library.add([])
        library.add(clips(("wave",)))
        assert len(ranking(library)) == len(SPEEDS)


def test_emptied_library_finds_nothing():
    library = build_clip_library(clips())
    library.remove(names(library))

    assert find_similar(act("wave"), library) == ()
    library.add(clips(("bow",)))
    assert len(ranking(library)) == len(SPEEDS)


@pytest.mark.parametrize("n_frames", [1, 2])
def test_clips_with_few_frames_are_accepted(n_frames):
    short = [Clip(name, act(name).slice(30, 30 + n_frames)) for name in ACTS]
    library = build_clip_library([*short, *clips()])

    assert len(ranking(library)) == len(ACTS) * (1 + len(SPEEDS))
    requested = FindSettings(n_neighbors=0)  # Of five clips the best five are all.
    found = find_similar(short[0].recording, build_clip_library(short), settings=requested)
    assert found[0].clip == ACTS[0]
    assert set(found[0].frames) <= set(range(n_frames))
    assert len(found[0].frames)


def test_clip_without_a_body_is_named_and_nothing_is_added():
    library = build_clip_library(clips())
    markers = Clip("some markers", Tracks(("a", "b"), np.zeros((9, 2, 3)), 30.0))
    missing = act("wave")
    unobserved = Clip("nobody", missing.with_positions(np.full_like(missing.positions, np.nan)))

    for bad, sentence in (
        (markers, "some markers: No body was"),
        (unobserved, "nobody: No joint"),
    ):
        with pytest.raises(InvalidMotionError, match=sentence):
            library.add([*clips(("wave",), (3.5,)), bad])
    assert len(library.entries) == len(ACTS) * len(SPEEDS)


def test_duplicate_and_unknown_names_are_refused():
    with pytest.raises(InvalidMotionError, match=r"Two clips have the name wave 1\.6"):
        build_clip_library(clips(("wave",)) + clips(("wave",)))
    library = build_clip_library(clips())
    with pytest.raises(InvalidMotionError, match=r"no clip jump\."):
        library.remove(["wave 2.0", "jump"])
    assert "wave 2.0" in names(library)


def test_cancelling_leaves_the_library_unchanged(tmp_path):
    build_clip_library(clips()).save(tmp_path / "library")
    with load_clip_library(tmp_path / "library") as library:
        before = ranking(library)
        for stop in (0.1, 0.6, 0.9):

            def cancel(fraction, message="", stop=stop):
                if fraction >= stop:
                    raise SolveCancelled

            with pytest.raises(SolveCancelled):
                library.add(clips(speeds=(1.8, 3.0)), progress=cancel)
        assert ranking(library) == before


def test_progress_rises_to_one():
    fractions = []
    build_clip_library(
        clips(), progress=lambda fraction, message="": fractions.append(fraction)
    )

    assert fractions == sorted(fractions)
    assert (fractions[0], fractions[-1]) == (0.0, 1.0)


def test_clips_are_not_modified():
    clip = Clip("a", act("wave"))
    before = replace(clip.recording, positions=clip.recording.positions.copy())
    build_clip_library([clip])
    assert_array_equal(clip.recording.positions, before.positions)
