"""Images that are dropped or damaged, or come late, keep the time of a followed motion."""

from dataclasses import replace
from time import monotonic, sleep

import numpy as np
import pytest
from drawn_bodies import recorded, waving
from numpy.testing import assert_array_equal
from recorders.followed_images import FAST, N_FRAMES, Written, follow

from solvers.errors import InvalidMotionError
from solvers.workflows.following import Clock


@pytest.fixture(scope="module")
def images():
    take = recorded(waving(N_FRAMES))
    return [take.frame(frame) for frame in range(N_FRAMES)]


@pytest.fixture(scope="module")
def followed(images):
    return follow(Written(images))


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


def test_delay_of_earlier_files_counts_from_the_start(images):
    """They were written at 0 s and are followed at 240 s."""
    source = Written(images, per_poll=[99])

    found = follow(source, clock=Clock(monotonic, lambda: 240.0, sleep))

    assert_array_equal(found.delays, np.zeros(N_FRAMES))


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


def test_damaged_images_end_with_the_recording_too(images):
    read = []

    class Damaged(Written):
        def read(self, image):
            read.append(image)
            return None if len(read) > 18 else super().read(image)

    found = follow(Damaged(images * 5), is_ended=lambda: len(read) >= 30)

    assert len(read) == 30 and found.motion.n_frames == 18
