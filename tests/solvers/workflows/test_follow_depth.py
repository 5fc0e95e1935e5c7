"""A recording that grows is tracked as the same images are offline, and nothing is lost."""

import multiprocessing
from dataclasses import replace

import numpy as np
import pytest
from drawn_bodies import CAMERA, recorded, waving
from numpy.testing import assert_allclose, assert_array_equal
from recorders.followed_images import BODY, FAST, FOREST, N_FRAMES, SETTINGS, Written, follow

from solvers.depth_scene import DepthRecording, ForegroundSettings, find_actor
from solvers.depth_tracking.capturing import (
    CaptureMethod,
    CaptureSettings,
    TrackingContext,
    track_with_restarts,
)
from solvers.depth_tracking.following import DelayedDetector
from solvers.depth_tracking.terms import DEFAULT_TRACKER
from solvers.errors import InvalidMotionError, InvalidSettingError
from solvers.progress import unwatched
from solvers.workflows.following import DetectorProcess, followed_take
from solvers.workflows.following.measure_followed import measure_followed


@pytest.fixture(scope="module")
def images():
    take = recorded(waving(N_FRAMES))
    return [take.frame(frame) for frame in range(N_FRAMES)]


@pytest.fixture(scope="module")
def followed(images):
    return follow(Written(images))


def test_followed_motion_is_the_causal_pass_offline(images, followed):
    recording = DepthRecording(CAMERA, N_FRAMES, 30.0, images.__getitem__)
    actor = find_actor(recording, ForegroundSettings()).recording
    context = TrackingContext(actor, BODY, FOREST, DEFAULT_TRACKER, SETTINGS)
    offline = track_with_restarts(context, range(N_FRAMES), None, unwatched)

    assert (followed.first, followed.n_dropped) == (0, 0)
    assert_array_equal(followed.captured.poses, offline.poses)
    assert followed.motion.n_frames == len(followed.delays) == N_FRAMES


def test_detector_of_another_process_gives_what_its_delays_give_here(images):
    with DetectorProcess() as detector:
        live = follow(Written(images), detector)

    again = follow(Written(images), DelayedDetector(FOREST, live.detection_delays))

    assert live.detection_delays  # their number depends on the speed of the machine
    # Linear algebra may have more threads in this process, which round in another order.
    assert_allclose(live.captured.poses, again.captured.poses, atol=1e-9)


def test_short_recording_is_tracked_too(images, followed):
    found = follow(Written(images), settings=replace(FAST, calibration=20.0))

    assert_array_equal(found.captured.poses, followed.captured.poses)


def test_actor_who_crosses_the_room_is_tracked_from_the_start():
    poses = waving(N_FRAMES)
    poses[:, 0] = np.linspace(-1.2, 1.2, N_FRAMES)
    take = recorded(poses)
    moving = [take.frame(frame) for frame in range(N_FRAMES)]

    found = follow(Written(moving), settings=replace(FAST, calibration=20.0))

    assert (found.first, found.motion.n_frames) == (0, N_FRAMES)


def test_ending_early_keeps_the_motion_so_far(images, followed):
    shown = []

    found = follow(Written(images), on_pose=shown.append, is_ended=lambda: len(shown) == 20)

    assert found.motion.n_frames == 20
    assert_array_equal(found.captured.poses, followed.captured.poses[:20])


def test_state_counts_what_is_tracked_and_has_the_actor_once_measured(images):
    states, sentences = [], []

    follow(
        Written(images),
        on_state=states.append,
        progress=lambda fraction, message: sentences.append(message),
    )

    assert len(states) == 15 + N_FRAMES  # those of the measurement are tracked afterwards
    assert [each.n_tracked for each in states] == [0] * 15 + [*range(1, N_FRAMES + 1)]
    assert [each.actor is not None for each in states[:16]] == [False] * 14 + [True] * 2
    assert states[0].depth.shape == (states[0].camera.height, states[0].camera.width)
    assert states[-1].sentence == sentences[-1]
    assert f"Tracking image {N_FRAMES}, " in sentences[-1] and "0 dropped." in sentences[-1]


def test_actor_who_comes_later_is_measured_then(images):
    empty = [np.zeros_like(images[0])] * 30

    found = follow(Written([*empty, *images]))

    assert found.first + found.motion.n_frames == 30 + N_FRAMES
    assert 23 <= found.first <= 30


@pytest.mark.parametrize(("n_empty", "seconds_per_unit"), [(5, 1.0 / 30.0), (30, 0.0)])
def test_actor_who_comes_late_after_the_empty_room_keeps_his_time(
    images, monkeypatch, n_empty, seconds_per_unit
):
    """Images are forgotten after those of the empty room, which are needed again."""
    nothing = np.zeros_like(images[0])
    source = Written([*[nothing] * 60, *images])
    source.seconds_per_unit = seconds_per_unit
    n_measured = []

    def measure(given, *words, empty=(), **options):
        assert list(empty) == list(range(n_empty))
        n_measured.append(len(given))
        return measure_followed(given, *words, empty=empty, **options)

    monkeypatch.setattr(followed_take, "measure_followed", measure)
    found = follow(source, empty=range(n_empty))

    assert 53 <= found.first <= 60
    assert found.first + found.motion.n_frames == 60 + N_FRAMES
    assert max(n_measured) == n_empty + 15 and len(n_measured) < 10


@pytest.mark.parametrize(
    ("n_images", "is_ended", "words"),
    [
        (0, False, "No depth image came"),
        (0, True, "No depth image came"),
        (3, True, "The recording ended before the actor was measured. Track it when it"),
    ],
)
def test_nothing_to_track_is_one_sentence(images, n_images, is_ended, words):
    with pytest.raises(InvalidMotionError, match=words):
        follow(Written(images[:n_images]), is_ended=lambda: is_ended)


def test_images_without_a_person_are_one_sentence(images):
    with pytest.raises(InvalidMotionError, match="No person is visible"):
        follow(Written([np.zeros_like(images[0])] * 20))


def test_published_methods_are_refused(images):
    settings = CaptureSettings(method=CaptureMethod.EDGES)
    with pytest.raises(InvalidSettingError, match="The method lou tracks one person"):
        follow(Written(images), capture=settings)


def test_killed_detector_does_not_stop_the_tracker(images):
    shown = []
    with DetectorProcess() as detector:

        def kill(pose):
            shown.append(pose)
            for process in multiprocessing.active_children():
                process.kill()

        found = follow(Written(images), detector, on_pose=kill)

    assert found.motion.n_frames == len(shown) == N_FRAMES
    assert detector.n_crashes > 0
