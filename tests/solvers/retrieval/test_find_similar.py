"""Searches find similar motion by any actor, at any position and tempo, with missing joints."""

from dataclasses import replace

import numpy as np
import pytest
from acted_clips import ACTS, act
from numpy.testing import assert_array_equal

from solvers.errors import InvalidMotionError
from solvers.motion import JointRecording, Sensor, Tracks
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS
from solvers.retrieval import (
    Clip,
    ClipLibrary,
    FindMethod,
    FindSettings,
    build_clip_library,
    find_similar,
)

NO_PARTS = dict.fromkeys(("trunk", "left_arm", "right_arm", "left_leg", "right_leg"), False)


@pytest.fixture(scope="module")
def library():
    return build_clip_library([
        Clip(f"{name} {number}", act(name, seconds, amount=amount, size=size), (name,))
        for name in ACTS
        for number, (seconds, amount, size) in enumerate(
            [(2.0, 1.0, 1.0), (2.6, 0.8, 1.1), (1.7, 1.15, 0.9)]
        )
    ])  # fmt: skip


def kinds(matches, n=3):
    return [match.clip.split()[0] for match in matches[:n]]


@pytest.mark.parametrize("name", ACTS)
@pytest.mark.parametrize(
    "done",
    [
        {"heading": 2.0, "position": (3.0, -5.0)},
        {"size": 1.25},
        {"seconds": 2.9},
        {"frame_rate": 120.0},
        {"amount": 0.9},
    ],
)
def test_same_action_is_found_first_in_any_variation(library, name, done):
    assert kinds(find_similar(act(name, **done), library)) == [name] * 3


def test_query_itself_is_the_best_match(library):
    best = find_similar(act("kick"), library, settings=FindSettings(n_neighbors=0))[0]
    assert best.clip == "kick 0"
    assert best.score > 0.98
    assert best.frames == range(60)
    query, clip = best.alignment.T
    assert np.abs(query - clip).max() <= 2


def test_all_clips_are_ranked_once_with_decreasing_scores(library):
    matches = find_similar(act("bow"), library)
    assert sorted(match.clip for match in matches) == sorted(
        entry.name for entry in library.entries
    )
    scores = [match.score for match in matches]
    assert scores == sorted(scores, reverse=True)
    assert all(0.0 <= score <= 1.0 for score in scores)
    assert find_similar(act("bow"), library, settings=FindSettings(n_matches=4)) != ()
    few = find_similar(act("bow"), library, settings=FindSettings(n_matches=4))
    assert [match.clip for match in few] == [match.clip for match in matches[:4]]


def test_query_can_be_excluded(library):
    names = [match.clip for match in find_similar(act("bow"), library, ignore=["bow 0"])]
    assert "bow 0" not in names
    assert len(names) == 14


def library_with_take(parts: list[Tracks]) -> ClipLibrary:
    """All acts but the kick, and a take of these parts one after the other."""
    take = Tracks(POSTURE_JOINTS, np.concatenate([part.positions for part in parts]), 30.0)
    return build_clip_library([
        Clip("take", take),
        *(Clip(name, act(name)) for name in ACTS if name != "kick"),
    ])


def test_action_is_found_within_a_long_take(library):
    long = library_with_take([
        act(name, 3.0) for name in ("step", "bow", "kick", "squat", "step")
    ])
    best = find_similar(act("kick", 2.7), long)[0]

    assert best.clip == "take"
    assert abs(best.frames.start - 180) < 20
    assert abs(best.frames.stop - 270) < 20
    query, clip = best.alignment.T
    assert (np.diff(query) >= 0).all()
    assert (np.diff(clip) >= 0).all()
    assert query[0] == 0
    assert query[-1] == 80
    assert best.frames == range(clip[0], clip[-1] + 1)


def test_action_longer_than_the_segment_that_is_found_has_its_end():
    """A kick that is half as fast as the query; segments of the take are 2 and 4 s long."""
    still = act("kick", 5.0, amount=0.0)
    library = library_with_take([still, act("kick", 2.7), still])

    best = find_similar(act("kick", 1.4), library)[0]

    assert best.clip == "take"
    assert abs(best.frames.start - 150) < 9
    assert abs(best.frames.stop - 231) < 9


def test_frames_of_matches_are_at_the_clips_own_rate():
    fast = build_clip_library([Clip("kick", act("kick", frame_rate=120.0))])
    best = find_similar(act("kick", frame_rate=60.0), fast)[0]
    assert best.frames.stop - best.frames.start > 220
    assert best.alignment[:, 0].max() <= 119
    assert best.alignment[:, 1].max() <= 239


def test_search_can_be_limited_to_body_parts(library):
    wave, kick = act("wave"), act("kick")
    mixed = wave.positions.copy()
    legs = [POSTURE_JOINTS.index(f"left{part}") for part in ("LowerLeg", "Foot", "Toes")]
    mixed[:, legs] = kick.positions[:, legs]
    both = replace(wave, positions=mixed)
    arm = FindSettings(**NO_PARTS | {"right_arm": True})
    leg = FindSettings(**NO_PARTS | {"left_leg": True})
    assert kinds(find_similar(both, library, settings=arm)) == ["wave"] * 3
    assert kinds(find_similar(both, library, settings=leg)) == ["kick"] * 3


@pytest.mark.parametrize("name", ["squat", "kick", "bow"])
def test_a_third_of_the_joints_may_be_missing(library, name):
    taken = np.random.default_rng(3).choice(np.arange(1, 20), 6, replace=False)
    query = act(name)
    query.positions[:, taken] = np.nan
    assert kinds(find_similar(query, library), 2) == [name] * 2
    query = act(name)
    query.positions[np.random.default_rng(4).random((60, 20)) < 0.3] = np.nan
    assert kinds(find_similar(query, library)) == [name] * 3


def test_query_may_be_a_sensor_recording(library):
    query = act("squat")
    shaken = query.positions + np.random.default_rng(0).normal(scale=0.02, size=(60, 20, 3))
    recording = JointRecording(replace(query, positions=shaken), None, Sensor.OTHER)
    assert kinds(find_similar(recording, library)) == ["squat"] * 3


def test_offset_joints_of_a_sensor_cost_less_than_of_a_motion(library):
    query = act("kick")
    offset = query.positions + np.random.default_rng(3).normal(scale=0.06, size=(20, 3))
    observed = replace(query, positions=offset, confidence=np.ones((query.n_frames, 20)))
    sensor, motion = (
        find_similar(one, library) for one in (observed, replace(observed, confidence=None))
    )
    assert kinds(sensor) == ["kick"] * 3
    assert sensor[0].score > motion[0].score + 0.02


def test_search_repeats_and_does_not_modify_its_input(library):
    query = act("wave")
    before = query.positions.copy()
    first, second = find_similar(query, library), find_similar(query, library)
    assert_array_equal(query.positions, before)
    assert [(one.clip, one.score) for one in first] == [(one.clip, one.score) for one in second]


@pytest.mark.parametrize("n_frames", [1, 2, 3])
def test_queries_and_clips_with_few_frames_are_accepted(library, n_frames):
    short = replace(act("kick"), positions=act("kick").positions[29 : 29 + n_frames])
    assert len(find_similar(short, library)) == 15
    separate = build_clip_library([Clip("short", short)])
    match = find_similar(act("kick"), separate)[0]
    assert match.frames.start >= 0
    assert match.frames.stop <= n_frames


def test_empty_library_has_no_matches():
    assert find_similar(act("kick"), build_clip_library([])) == ()


def test_invalid_queries_are_refused(library):
    with pytest.raises(InvalidMotionError, match="No part of the body is chosen"):
        find_similar(act("kick"), library, settings=FindSettings(**NO_PARTS))
    unobserved = act("kick")
    arm = [POSTURE_JOINTS.index(f"left{part}") for part in ("UpperArm", "LowerArm", "Hand")]
    unobserved.positions[:, arm] = np.nan
    with pytest.raises(InvalidMotionError, match="no tracked joints in: left arm"):
        find_similar(
            unobserved, library, settings=FindSettings(**NO_PARTS | {"left_arm": True})
        )
    unobserved.positions[:] = np.nan
    with pytest.raises(InvalidMotionError, match="No joint was tracked"):
        find_similar(unobserved, library)


def test_published_method_can_be_selected():
    """Actions in place, since it uses postures only; cached while the library is unchanged."""
    library = build_clip_library([
        Clip(f"{name} {number}", act(name, seconds, amount=amount), (name,))
        for name in ("wave", "squat", "kick", "bow")
        for number, (seconds, amount) in enumerate([(4.0, 1.0), (3.2, 0.9), (4.5, 1.1)])
    ])  # fmt: skip
    published = FindSettings(method=FindMethod.PUBLISHED)
    first = find_similar(act("kick", 4.0), library, settings=published)
    assert first[0].clip == "kick 0"
    assert first[0].score > 1.5 * first[-1].score
    assert len(first) == 12
    others = find_similar(act("kick", 4.0), library, settings=published, ignore=["kick 0"])
    assert "kick 0" not in [match.clip for match in others]
    library.remove(["kick 0"])
    assert len(find_similar(act("kick", 4.0), library, settings=published)) == 11
