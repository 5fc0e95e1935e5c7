"""Rates, times and numbers next to the frames of people in JSON count, and all groups."""

import json

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import find_humanoid_map, forward_kinematics
from solvers.recordings import list_bodies, read_recording
from solvers.samples import walking_gait

F = 30
PARTS = {"shoulder": "UpperArm", "elbow": "LowerArm", "wrist": "Hand", "hip": "UpperLeg",
         "knee": "LowerLeg", "ankle": "Foot"}  # fmt: skip
ROLES = {f"{side}_{part}": side + role for part, role in PARTS.items()
         for side in ("left", "right")}  # fmt: skip


@pytest.fixture(scope="module")
def frames():
    """Return the joints of a walker in each frame, meters, Y up."""
    motion = walking_gait()
    positions = forward_kinematics(motion).positions[:F][..., [0, 2, 1]] * (1.0, 1.0, -1.0)
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    return [
        {name: positions[k, roles[role]].tolist() for name, role in ROLES.items()}
        for k in range(F)
    ]


def by_joint(frames):
    return {name: [frame[name] for frame in frames] for name in ROLES}


def arrays(frames):
    return [[frame["left_shoulder"]] * 5 + [frame[name] for name in ROLES] for frame in frames]


def test_people_of_the_same_name_in_two_groups_are_all_listed(tmp_path, frames):
    """Those of the second group do not take the places of the first."""
    group = {"1": {"frames": frames}, "2": {"frames": frames}}
    path = write(tmp_path, {"team1": group, "team2": group})

    assert [(body.name, body.n_frames) for body in list_bodies(path)] == [
        ("1", F), ("2", F), ("team2 1", F), ("team2 2", F),
    ]  # fmt: skip


def test_lists_of_people_with_the_same_identities_are_all_listed(tmp_path, frames):
    group = [{"id": who, "frames": frames} for who in (1, 2)]
    path = write(tmp_path, {"team1": group, "team2": group})

    assert [body.n_frames for body in list_bodies(path)] == [F] * 4


def test_a_person_with_the_name_of_another_in_a_group_is_listed(tmp_path, frames):
    path = write(tmp_path, {"team": {"anna": frames, "ben": frames}, "anna": frames})

    assert sorted((body.name, body.n_frames) for body in list_bodies(path)) == [
        ("anna", F), ("ben", F), ("team anna", F),
    ]  # fmt: skip


TIMES = [k / 60 for k in range(F)]
RATES = {
    "below a key": lambda frames: {"data": {"fps": 60, "frames": frames}},
    "below two keys": lambda frames: {"data": {"take": {"fps": 60, "frames": frames}}},
    "of a person": lambda frames: {
        who: {"fps": 60, "joints": by_joint(frames)} for who in ("anna", "ben")
    },
    "of a group": lambda frames: {"team": {"FrameRate": 60, "anna": frames, "ben": frames}},
    "in a list": lambda frames: [
        {"id": who, "fps": 60, "frames": frames} for who in ("anna", "ben")
    ],
    "times": lambda frames: {"anna": {"timestamps": TIMES, "joints": by_joint(frames)}},
    "times of lists": lambda frames: {"anna": {"timestamps": TIMES, "joints": arrays(frames)}},
    "whole milliseconds": lambda frames: {
        "anna": {"timestamps_ms": [round(1000 * time) for time in TIMES], "frames": frames}
    },
    "times of two": lambda frames: {
        who: {"time": TIMES, "frames": frames} for who in ("anna", "ben")
    },
}


@pytest.mark.parametrize("layout", RATES)
def test_the_rate_next_to_frames_is_that_of_the_take(tmp_path, frames, layout):
    """It counts as a frame: otherwise the take has half its speed."""
    path = write(tmp_path, RATES[layout](frames))
    bodies = list_bodies(path)

    tracks = read_recording(path, body=bodies[0].name if bodies else None).tracks

    assert tracks.frame_rate == pytest.approx(60.0, rel=0.02)
    assert tracks.n_frames == F


@pytest.mark.parametrize("ben", [{"fps": 60}, {"time": TIMES}, {"fps": 30, "time": TIMES}])
def test_people_with_different_clocks_are_refused(tmp_path, frames, ben):
    content = {"anna": {"fps": 30, "frames": frames}, "ben": {**ben, "frames": frames}}

    with pytest.raises(InvalidFileError, match="at different frame rates, or with and without"):
        list_bodies(write(tmp_path, content))


def test_start_frames_say_when_each_person_is_seen(tmp_path, frames):
    content = {
        who: {"start_frame": start, "frames": frames}
        for who, start in {"anna": 0, "ben": 20}.items()
    }

    anna, ben = list_bodies(write(tmp_path, content))

    assert (anna.first, anna.last, ben.first, ben.last) == (0, 29, 20, 49)


def test_numbers_of_frames_that_repeat_do_not_count(tmp_path, frames):
    """Frames with the same number are not dropped without a word."""
    content = {"anna": {"frame_ids": [k // 2 for k in range(F)], "frames": frames}}

    assert read_recording(write(tmp_path, content)).tracks.n_frames == F


@pytest.mark.parametrize("number", [float("nan"), float("inf"), 10**400, True, "1"])
@pytest.mark.parametrize("key", ["frame_ids", "timestamps"])
def test_numbers_of_frames_that_are_none_do_not_count(tmp_path, frames, key, number):
    content = {"anna": {key: [number, *range(1, F)], "frames": frames}}

    assert read_recording(write(tmp_path, content)).tracks.n_frames == F


@pytest.mark.parametrize("start", [float("nan"), 10**400, 10**299, 0.5, -3, None])
def test_a_start_frame_moves_all_frames_or_none(tmp_path, frames, start):
    content = {"anna": {"start_frame": start, "frames": frames}}

    assert read_recording(write(tmp_path, content)).tracks.n_frames == F


def test_deeply_nested_members_are_refused(tmp_path):
    content = {"a": [0.0, 1.0, 2.0]}
    for _ in range(600):
        content = {"a": content}

    with pytest.raises(InvalidFileError):
        read_recording(write(tmp_path, {"joints": content}))


def test_frames_are_found_below_some_members(tmp_path, frames):
    content = {"session": {"take": {"person": {"data": {"frames": frames}}}}}

    assert np.isfinite(read_recording(write(tmp_path, content)).tracks.positions).all()


def write(folder, content):
    path = folder / "take.json"
    path.write_text(json.dumps(content))
    return path
