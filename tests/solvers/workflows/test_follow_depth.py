"""A recording that grows is tracked as the same images are offline, and nothing is lost."""

import multiprocessing
from dataclasses import replace

import numpy as np
import pytest
from drawn_bodies import CAMERA, recorded, waving
from numpy.testing import assert_allclose, assert_array_equal

from solvers.depth_scene import DepthRecording, ForegroundSettings, find_actor
from solvers.depth_tracking.body import default_body
from solvers.depth_tracking.capturing import (
    CaptureMethod,
    CaptureSettings,
    TrackingContext,
    track_with_restarts,
)
from solvers.depth_tracking.following import DelayedDetector
from solvers.depth_tracking.forest import load_pixel_forest
from solvers.depth_tracking.terms import DEFAULT_TRACKER
from solvers.errors import InvalidMotionError, InvalidSettingError
from solvers.progress import unwatched
from solvers.recordings.growing import ImagePositions, NewImage
from solvers.workflows.following import (
    Clock,
    DetectorProcess,
    FollowSettings,
    follow_depth,
    followed_take,
)
from solvers.workflows.following.measure_followed import measure_followed

BODY = default_body()
FOREST = load_pixel_forest()
FAST = FollowSettings(calibration=0.5, max_silence=0.5, max_wait=0.5, max_delay=0.0)
SETTINGS = CaptureSettings(check_every=6)
N_FRAMES = 24


class Written:
    """Images that a recorder has written by each poll."""

    def __init__(self, images, positions=None, per_poll=(1,)):
        self.camera, self.is_gone, self.issue = CAMERA, False, "No depth image came."
        self._images, self._per_poll = images, [*per_poll]
        self.seconds_per_unit = 1.0 / 30.0
        positions = range(len(images)) if positions is None else positions
        self._new = [NewImage(str(n), float(at), 0.0) for n, at in enumerate(positions)]

    def poll(self):
        n_new = self._per_poll[0]
        if len(self._per_poll) > 1:
            del self._per_poll[0]
        now, self._new = self._new[:n_new], self._new[n_new:]
        return now

    def read(self, image):
        return self._images[int(image.name)]

    def positions(self, positions):
        return ImagePositions(30.0, self.seconds_per_unit)

    def remarks(self):
        return ()


@pytest.fixture(scope="module")
def images():
    take = recorded(waving(N_FRAMES))
    return [take.frame(frame) for frame in range(N_FRAMES)]


def follow(source, detector=None, **options):
    given = {"settings": FAST, "capture": SETTINGS} | options
    return follow_depth(source, detector or DelayedDetector(FOREST), BODY, **given)


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

    assert len(live.detection_delays) >= 2
    # Linear algebra may have more threads in this process, which round in another order.
    assert_allclose(live.captured.poses, again.captured.poses, atol=1e-9)


@pytest.mark.parametrize("seconds_per_unit", [1.0 / 30.0, 0.0])
def test_images_that_wait_too_long_are_dropped_and_their_poses_interpolated(
    images, seconds_per_unit
):
    """Fifteen images are for the calibration, and eight come during it; then two for each one
    that is tracked in 0.05 s.

    Images keep their time, whether their names have numbers or only an order.
    """
    source = Written(images * 3, per_poll=[*[1] * 15, 8, 2])
    source.seconds_per_unit = seconds_per_unit
    elapsed = []
    clock = Clock(lambda: 0.05 * len(elapsed), lambda: 0.0, elapsed.append)

    found = follow(
        source, settings=replace(FAST, max_delay=0.1), clock=clock, on_pose=elapsed.append
    )

    assert 15 < found.first <= 15 + 8 + 6
    assert found.first + found.motion.n_frames == 3 * N_FRAMES
    assert found.remarks[-2] == (
        f"The motion begins with frame {found.first} ({found.first / 30.0:.1f} s) of the"
        " recording."
    )
    assert found.remarks[-1].startswith(f"{found.n_dropped} later images were dropped")
    n_left = found.motion.n_frames - found.n_dropped
    assert len(found.delays) == n_left < 0.8 * found.motion.n_frames
    is_tracked = found.captured.joints.confidence.any(axis=1)
    assert is_tracked.sum() == n_left
    assert np.isfinite(found.captured.poses).all()


@pytest.mark.parametrize("seconds_per_unit", [1.0 / 30.0, 0.0])
def test_many_dropped_images_keep_the_time_of_the_later_ones(images, seconds_per_unit):
    """200 images, more than six seconds, come at once after the calibration."""
    n_images, n_dropped = 15 + 200 + N_FRAMES, 200
    source = Written((images * 10)[:n_images], per_poll=[*[1] * 15, n_dropped, 1])
    source.seconds_per_unit = seconds_per_unit
    elapsed = []
    clock = Clock(lambda: 0.2 * len(elapsed), lambda: 0.0, elapsed.append)

    found = follow(
        source, settings=replace(FAST, max_delay=0.1), clock=clock, on_pose=elapsed.append
    )

    assert 15 + n_dropped <= found.first <= 15 + n_dropped + 2
    assert found.remarks[-1].startswith(f"The motion begins with frame {found.first} (7.")
    assert found.first + found.motion.n_frames == n_images


def test_images_that_come_in_bursts_are_not_dropped(images, followed):
    """As those of k4arecorder: all of a second at once, and the next ones after these."""
    source = Written(images, per_poll=[8, *[0] * 20, 8, *[0] * 30, 8])
    elapsed = []
    clock = Clock(lambda: 0.05 * len(elapsed), lambda: 0.0, elapsed.append)

    found = follow(
        source,
        settings=replace(FAST, max_delay=0.1, max_silence=10.0),
        clock=clock,
        on_pose=elapsed.append,
    )

    assert found.n_dropped == 0
    assert_array_equal(found.captured.poses, followed.captured.poses)


def test_recording_that_ended_is_tracked_completely(images, followed):
    """All images are there at once: no newer one waits, so none is dropped."""
    found = follow(Written(images, per_poll=[99]), settings=replace(FAST, max_delay=0.1))

    assert_array_equal(found.captured.poses, followed.captured.poses)


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


def test_gaps_in_numbering_stay_in_time_and_jumps_of_the_clock_do_not(images, followed):
    numbers = np.arange(N_FRAMES)
    gap, ahead, back = (numbers.astype(float) for _ in range(3))
    gap[20:] += 5.0
    ahead[20:] += 1e6
    back[20:] -= 1e6

    lengths = [follow(Written(images, each)).motion.n_frames for each in (gap, ahead, back)]

    assert lengths == [N_FRAMES + 5, N_FRAMES, N_FRAMES]


@pytest.mark.parametrize("seconds_per_unit", [1.0 / 30.0, 0.0])
def test_damaged_images_are_gaps(images, seconds_per_unit):
    damaged = [None if number in {3, 19, 20} else each for number, each in enumerate(images)]

    source = Written(damaged)
    source.seconds_per_unit = seconds_per_unit

    found = follow(source)

    assert found.motion.n_frames == N_FRAMES
    is_tracked = found.captured.joints.confidence.any(axis=1)
    assert_array_equal(np.flatnonzero(~is_tracked), [3, 19, 20])


def test_ending_early_keeps_the_motion_so_far(images, followed):
    shown = []

    found = follow(Written(images), on_pose=shown.append, is_ended=lambda: len(shown) == 20)

    assert found.motion.n_frames == 20
    assert_array_equal(found.captured.poses, followed.captured.poses[:20])


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


def test_damaged_images_end_with_the_recording_too(images):
    read = []

    class Damaged(Written):
        def read(self, image):
            read.append(image)
            return None if len(read) > 18 else super().read(image)

    found = follow(Damaged(images * 5), is_ended=lambda: len(read) >= 30)

    assert len(read) == 30 and found.motion.n_frames == 18


@pytest.mark.parametrize(
    ("n_images", "is_ended", "words"),
    [
        (0, False, "No depth image came"),
        (0, True, "No depth image came"),
        (3, True, "The recording ended before the actor was measured. Capture it without"),
    ],
)
def test_nothing_to_track_is_one_sentence(images, n_images, is_ended, words):
    with pytest.raises(InvalidMotionError, match=words):
        follow(Written(images[:n_images]), is_ended=lambda: is_ended)


def test_recording_that_ended_during_the_measurement_is_one_sentence(images):
    """Those that came during it are dropped for newer ones, which are damaged."""
    source = Written([*images, *[None] * 3], per_poll=[*[1] * 15, 9, *[0] * 15, 1])
    elapsed = []
    clock = Clock(lambda: 0.2 * len(elapsed), lambda: 0.0, elapsed.append)
    settings = replace(FAST, max_delay=0.1, max_silence=9.0)

    def show(fraction, message):
        elapsed.append(message)

    with pytest.raises(InvalidMotionError, match="The recording ended before the actor was"):
        follow(source, settings=settings, clock=clock, progress=show)


def test_images_without_a_person_are_one_sentence(images):
    with pytest.raises(InvalidMotionError, match="No person is visible"):
        follow(Written([np.zeros_like(images[0])] * 20))


def test_published_methods_are_refused(images):
    settings = CaptureSettings(method=CaptureMethod.EDGES)
    with pytest.raises(InvalidSettingError, match="Published methods track complete"):
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
