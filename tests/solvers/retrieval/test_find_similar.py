"""Searches find what is alike, whoever did it, wherever, however fast, whatever was lost."""

from dataclasses import replace

import numpy as np
import pytest
from acted import ACTS, act
from numpy.testing import assert_array_equal

from solvers.errors import InvalidMotionError
from solvers.motion import JointRecording, Sensor, Tracks
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS
from solvers.retrieval import Clip, FindMethod, FindSettings, build_clip_library, find_similar

KEPT = dict.fromkeys(("trunk", "left_arm", "right_arm", "left_leg", "right_leg"), False)


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
        {"heading": 2.0, "place": (3.0, -5.0)},
        {"size": 1.25},
        {"seconds": 2.9},
        {"frame_rate": 120.0},
        {"amount": 0.9},
    ],
)
def test_the_same_act_is_found_first_however_it_is_done(library, name, done):
    assert kinds(find_similar(act(name, **done), library)) == [name] * 3


def test_the_clip_itself_is_the_best_match_and_scores_nearly_one(library):
    best = find_similar(act("kick"), library, settings=FindSettings(n_alike=0))[0]
    assert best.clip == "kick 0"
    assert best.score > 0.98
    assert best.frames == range(60)
    query, clip = best.alignment.T
    assert np.abs(query - clip).max() <= 2


def test_all_clips_are_ranked_once_and_scores_fall(library):
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


def test_the_query_is_left_out_where_asked(library):
    names = [match.clip for match in find_similar(act("bow"), library, ignore=["bow 0"])]
    assert "bow 0" not in names
    assert len(names) == 14


def test_an_act_is_found_within_a_long_take(library):
    parts = [act(name, 3.0) for name in ("step", "bow", "kick", "squat", "step")]
    take = Tracks(POSTURE_JOINTS, np.concatenate([part.positions for part in parts]), 30.0)
    long = build_clip_library([
        Clip("take", take),
        *(Clip(name, act(name)) for name in ACTS if name != "kick"),
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


def test_frames_are_told_in_the_clips_own_rate():
    fast = build_clip_library([Clip("kick", act("kick", frame_rate=120.0))])
    best = find_similar(act("kick", frame_rate=60.0), fast)[0]
    assert best.frames.stop - best.frames.start > 220
    assert best.alignment[:, 0].max() <= 119
    assert best.alignment[:, 1].max() <= 239


def test_parts_of_the_body_are_asked_for_alone(library):
    wave, kick = act("wave"), act("kick")
    mixed = wave.positions.copy()
    legs = [POSTURE_JOINTS.index(f"left{part}") for part in ("LowerLeg", "Foot", "Toes")]
    mixed[:, legs] = kick.positions[:, legs]
    both = replace(wave, positions=mixed)
    arm = FindSettings(**KEPT | {"right_arm": True})
    leg = FindSettings(**KEPT | {"left_leg": True})
    assert kinds(find_similar(both, library, settings=arm)) == ["wave"] * 3
    assert kinds(find_similar(both, library, settings=leg)) == ["kick"] * 3


@pytest.mark.parametrize("name", ["squat", "kick", "bow"])
def test_a_third_of_the_joints_may_be_lost(library, name):
    taken = np.random.default_rng(3).choice(np.arange(1, 20), 6, replace=False)
    query = act(name)
    query.positions[:, taken] = np.nan
    assert kinds(find_similar(query, library), 2) == [name] * 2
    query = act(name)
    query.positions[np.random.default_rng(4).random((60, 20)) < 0.3] = np.nan
    assert kinds(find_similar(query, library)) == [name] * 3


def test_a_sensor_may_ask(library):
    query = act("squat")
    shaken = query.positions + np.random.default_rng(0).normal(scale=0.02, size=(60, 20, 3))
    recording = JointRecording(replace(query, positions=shaken), None, Sensor.OTHER)
    assert kinds(find_similar(recording, library)) == ["squat"] * 3


def test_joints_that_a_sensor_puts_elsewhere_cost_less_than_those_of_a_motion(library):
    query = act("kick")
    aside = query.positions + np.random.default_rng(3).normal(scale=0.06, size=(20, 3))
    seen = replace(query, positions=aside, confidence=np.ones((query.n_frames, 20)))
    sensor, motion = (
        find_similar(one, library) for one in (seen, replace(seen, confidence=None))
    )
    assert kinds(sensor) == ["kick"] * 3
    assert sensor[0].score > motion[0].score + 0.02


def test_the_inputs_are_as_they_were_and_the_answer_is_the_same(library):
    query = act("wave")
    before = query.positions.copy()
    first, second = find_similar(query, library), find_similar(query, library)
    assert_array_equal(query.positions, before)
    assert [(one.clip, one.score) for one in first] == [(one.clip, one.score) for one in second]


@pytest.mark.parametrize("n_frames", [1, 2, 3])
def test_queries_and_clips_of_few_frames(library, n_frames):
    short = replace(act("kick"), positions=act("kick").positions[29 : 29 + n_frames])
    assert len(find_similar(short, library)) == 15
    alone = build_clip_library([Clip("short", short)])
    match = find_similar(act("kick"), alone)[0]
    assert match.frames.start >= 0
    assert match.frames.stop <= n_frames


def test_an_empty_library_has_nothing():
    assert find_similar(act("kick"), build_clip_library([])) == ()


def test_what_cannot_be_asked_is_said(library):
    with pytest.raises(InvalidMotionError, match="No part of the body is chosen"):
        find_similar(act("kick"), library, settings=FindSettings(**KEPT))
    blind = act("kick")
    arm = [POSTURE_JOINTS.index(f"left{part}") for part in ("UpperArm", "LowerArm", "Hand")]
    blind.positions[:, arm] = np.nan
    with pytest.raises(InvalidMotionError, match="no tracked joints in: left arm"):
        find_similar(blind, library, settings=FindSettings(**KEPT | {"left_arm": True}))
    blind.positions[:] = np.nan
    with pytest.raises(InvalidMotionError, match="No joint was tracked"):
        find_similar(blind, library)


def test_the_published_form_can_be_chosen():
    """Acts in place, since it looks at postures only; kept while the library is as it was."""
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
