"""The actor, cut out of rooms that were put behind a recording of nothing else."""

from dataclasses import replace

import numpy as np
import pytest
from depth_rooms import in_room, room, tilted

from solvers.depth_scene.bodies import find_bodies
from solvers.depth_scene.camera import Camera
from solvers.depth_scene.floor import find_floor
from solvers.depth_scene.foreground import (
    ForegroundMethod,
    ForegroundSettings,
    cut_out_actor,
    learn_background,
)
from solvers.depth_scene.recording import DepthRecording
from solvers.errors import InvalidMotionError
from solvers.recordings import read_depth

KINECT = Camera(285.63, 285.63, 159.5, 119.5, 320, 240)
UP = tilted(0.0)
SUBTRACTED = ForegroundSettings(way=ForegroundMethod.BACKGROUND)
AS_RECORDED = ForegroundSettings(way=ForegroundMethod.RECORDED)


@pytest.fixture
def actor(recordings) -> DepthRecording:
    return read_depth(recordings / "depth" / "truth" / "walk_front.npz")


def agreement(found: np.ndarray, true: np.ndarray) -> float:
    """Intersection over union."""
    return float((found & true).sum() / (found | true).sum())


def test_background_from_empty_frames(actor):
    empty = room(KINECT, UP, 0.95, 4.5)
    nobody = DepthRecording(KINECT, 30, 30.0, lambda _: np.zeros((240, 320), np.float32))
    background = learn_background(in_room(nobody, empty, 0.0015), range(30))

    alone = cut_out_actor(in_room(actor, empty, 0.0015), SUBTRACTED, background=background)

    for frame in range(0, actor.n_frames, 15):
        assert agreement(alone.frame(frame) > 0.0, actor.frame(frame) > 0.0) > 0.9


def test_cut_by_distance_and_floor(actor):
    taken = in_room(actor, room(KINECT, UP, 0.95, 4.5), 0.0015)

    alone = cut_out_actor(
        taken,
        ForegroundSettings(way=ForegroundMethod.CUT, farthest=4.2),
        floor=find_floor(taken),
    )

    for frame in range(0, actor.n_frames, 15):
        assert agreement(alone.frame(frame) > 0.0, actor.frame(frame) > 0.0) > 0.88


def test_as_recorded_only_noise_goes(recordings):
    for path in sorted((recordings / "depth" / "utd_mhad").glob("*_s5_t1_depth.mat")):
        taken = read_depth(path)
        alone = cut_out_actor(taken, AS_RECORDED)
        frame = taken.n_frames // 2
        assert agreement(alone.frame(frame) > 0.0, taken.frame(frame) > 0.0) > 0.99


def test_of_two_people_the_one_of_whom_more_is_seen_stays(actor):
    def with_another(frame):
        first = actor.frame(frame)
        second = np.roll(first[::2, ::2], 0)
        behind = np.zeros_like(first)
        behind[120:, :160] = 2.0 * second  # A child: half the size, seen at the same scale.
        return np.where(first > 0.0, first, behind)

    taken = replace(actor, read_depth=with_another)
    alone = cut_out_actor(taken, AS_RECORDED)

    bodies = find_bodies(taken.frame(40), taken.camera, 0.08)
    assert len(bodies.areas) == 2
    assert agreement(alone.frame(40) > 0.0, actor.frame(40) > 0.0) > 0.98


def test_where_nobody_is_nothing_is_left():
    empty = DepthRecording(KINECT, 2, 30.0, lambda _: np.zeros((240, 320), np.float32))

    assert cut_out_actor(empty).frame(1).max() == 0.0


def test_the_empty_room_must_be_known_and_fit(actor):
    with pytest.raises(InvalidMotionError, match="Name frames without the actor"):
        cut_out_actor(actor, SUBTRACTED)
    with pytest.raises(InvalidMotionError, match="from no frame at all"):
        learn_background(actor, [])


def test_the_empty_room_is_median_and_spread(rng):
    depth = (2.0 + 0.02 * rng.normal(size=(50, 240, 320))).astype(np.float32)
    depth[:30, 0, 0] = 0.0
    depth[:10, 0, 1] = 0.0

    background = learn_background(
        DepthRecording(KINECT, 50, 30.0, lambda frame: depth[frame]), range(50)
    )

    assert background.depth[0, 0] == 0.0
    assert background.depth[0, 1] == pytest.approx(np.median(depth[10:, 0, 1]))
    assert np.median(background.spread) == pytest.approx(0.02, rel=0.05)
