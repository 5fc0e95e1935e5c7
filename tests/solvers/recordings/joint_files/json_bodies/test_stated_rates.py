"""The rate of JSON is that of its frames, not one of sound, sampling or another clock."""

import json

import pytest
from exports.camera_bodies import mediapipe
from pytest import approx

from solvers.recordings.joint_files.json_bodies.joined_frames import frozen_clocks

N = 40
POINTS = mediapipe(N)


def frame(k, **others):
    points = [dict(zip("xyz", row, strict=True)) for row in POINTS[k, :, :3].tolist()]
    return {"landmarks": points, **others}


FRAMES = [frame(k) for k in range(N)]


@pytest.mark.parametrize(
    "others",
    [
        {"audio": {"sample_rate": 44100}, "fps": 25},
        {"metadata": {"audio": {"sample_rate": 44100}, "fps": 25}},
        {"sample_rate": 5, "fps": 25},
        {"info": {"sampling_rate": 1}, "fps": 25},
        {"camera": {"fps": 60}, "fps": 25},
        {"metadata": {"fps": 25, "timestamp": 1712345678, "frame": N}},
    ],
)
def test_the_rate_of_frames_comes_first(read_any, collected_messages, others):
    """The first rate of a file need not be that of its frames."""
    messages, progress = collected_messages

    recording = read_any(json.dumps({**others, "frames": FRAMES}), progress=progress)

    assert recording.tracks.frame_rate == approx(25.0)
    assert not any("stand still" in message for message in messages)


def test_a_rate_of_sound_is_not_one_of_frames(read_any):
    take = {"audio": {"sample_rate": 8000}, "frames": FRAMES}

    assert read_any(json.dumps(take)).tracks.frame_rate == approx(30.0)


def test_numbers_in_steps_do_not_matter_to_frames_with_times(read_any, collected_messages):
    """The remark states the rate of the take."""
    messages, progress = collected_messages
    frames = [frame(k, frame=2 * k, time=k / 25.0) for k in range(N)]

    recording = read_any(json.dumps({"fps": 30, "frames": frames}), progress=progress)

    assert recording.tracks.frame_rate == approx(25.0)
    assert not any("steps" in message for message in messages)


def test_the_time_of_one_frame_does_not_stand_still():
    stamp = {"time": (5.0, 1.0)}

    assert frozen_clocks([stamp]) == set()
    assert frozen_clocks([stamp, stamp]) == {"time"}


@pytest.mark.parametrize(
    "layout",
    [
        lambda frames: frames,
        lambda frames: {"frames": frames},
        lambda frames: {f"frame_{each['frame']:04}": each["landmarks"] for each in frames},
        lambda frames: {"frames": {str(each["frame"]): each["landmarks"] for each in frames}},
    ],
    ids=["list", "member", "names", "keys"],
)
@pytest.mark.parametrize(
    ("stated", "rate", "step"),
    [(None, 30.0, 1), (None, 30.0, 2), (60.0, 60.0, 1), (60.0, 60.0, 2), (60.0, 60.0, 5)],
)
def test_frames_in_steps_have_a_part_of_the_rate(
    read_any, collected_messages, layout, stated, rate, step
):
    messages, progress = collected_messages
    take = layout([frame(k, frame=step * k) for k in range(N)])
    if stated:
        take = {"fps": stated, **(take if isinstance(take, dict) else {"frames": take})}

    recording = read_any(json.dumps(take), progress=progress)

    assert recording.tracks.frame_rate == approx(rate / step)
    assert recording.tracks.n_frames == N
    assert any(f"in steps of {step}" in message for message in messages) == (step > 1)
    assert any("30 Hz is assumed" in message for message in messages) == (stated is None)


@pytest.mark.parametrize(
    ("step", "stated", "rate"),
    [(33, 30.0, 30.0), (16, 60.0, 60.0), (20000, 50.0, 50.0), (5, None, 30.0)],
)
@pytest.mark.parametrize("is_keyed", [False, True])
def test_numbers_that_are_times_do_not_divide_the_rate(read_any, step, stated, rate, is_keyed):
    """Rounded to 16 ms, 60 Hz must not become 3.75 Hz; microseconds are times."""
    frames = [frame(k, frame=step * k) for k in range(N)]
    keyed = {str(each["frame"]): each["landmarks"] for each in frames}
    take = {"frames": keyed if is_keyed else frames} | ({"fps": stated} if stated else {})

    assert read_any(json.dumps(take)).tracks.frame_rate == approx(rate)


@pytest.mark.parametrize("key", ["index", "idx"])
def test_an_index_is_no_number_of_a_frame(read_any, key):
    """It is often that of a body; frames of the same number would be joined."""
    frames = [frame(k, **{key: k % 2}) for k in range(N)]

    assert read_any(json.dumps(frames)).tracks.n_frames == N
