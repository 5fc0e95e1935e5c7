"""Segmentation of the actor from synthetic rooms behind a recording of the actor alone."""

from dataclasses import replace

import numpy as np
import pytest
from depth_rooms import in_room, room, tilted
from numpy.testing import assert_allclose

from solvers.depth_scene.actor import find_actor
from solvers.depth_scene.bodies import find_bodies
from solvers.depth_scene.camera import Camera
from solvers.depth_scene.floor import find_floor
from solvers.depth_scene.foreground import (
    ForegroundMethod,
    ForegroundSettings,
    cut_out_actor,
    is_in_front,
    learn_background,
    uncovered_background,
)
from solvers.depth_scene.recording import DepthRecording
from solvers.errors import InvalidMotionError
from solvers.recordings import read_depth

KINECT = Camera(285.63, 285.63, 159.5, 119.5, 320, 240)
UP = tilted(0.0)
SUBTRACTED = ForegroundSettings(actor_mask=ForegroundMethod.BACKGROUND)
AS_RECORDED = ForegroundSettings(actor_mask=ForegroundMethod.RECORDED)


@pytest.fixture
def actor(recordings) -> DepthRecording:
    return read_depth(recordings / "depth" / "truth" / "walk_front.npz")


def agreement(found: np.ndarray, true: np.ndarray) -> float:
    """Intersection over union."""
    return float((found & true).sum() / (found | true).sum())


def test_cut_out_actor_uses_the_learned_background(actor):
    empty = room(KINECT, UP, 0.95, 4.5)
    empty_images = DepthRecording(KINECT, 30, 30.0, lambda _: np.zeros((240, 320), np.float32))
    background = learn_background(in_room(empty_images, empty, 0.0015), range(30))

    actor_only = cut_out_actor(in_room(actor, empty, 0.0015), SUBTRACTED, background=background)

    for frame in range(0, actor.n_frames, 15):
        assert agreement(actor_only.frame(frame) > 0.0, actor.frame(frame) > 0.0) > 0.9


def test_cut_out_actor_uses_distance_and_floor(actor):
    recording = in_room(actor, room(KINECT, UP, 0.95, 4.5), 0.0015)

    actor_only = cut_out_actor(
        recording,
        ForegroundSettings(actor_mask=ForegroundMethod.CUT, max_distance=4.2),
        floor=find_floor(recording),
    )

    for frame in range(0, actor.n_frames, 15):
        assert agreement(actor_only.frame(frame) > 0.0, actor.frame(frame) > 0.0) > 0.88


def test_recorded_method_removes_only_noise(recordings):
    for path in sorted((recordings / "depth" / "utd_mhad").glob("*_s5_t1_depth.mat")):
        recording = read_depth(path)
        actor_only = cut_out_actor(recording, AS_RECORDED)
        frame = recording.n_frames // 2
        assert agreement(actor_only.frame(frame) > 0.0, recording.frame(frame) > 0.0) > 0.99


def test_cut_out_actor_keeps_the_more_visible_person(actor):
    def with_another(frame):
        first = actor.frame(frame)
        second = np.roll(first[::2, ::2], 0)
        behind = np.zeros_like(first)
        behind[120:, :160] = 2.0 * second  # A child: half the size at the same scale.
        return np.where(first > 0.0, first, behind)

    recording = replace(actor, read_depth=with_another)
    actor_only = cut_out_actor(recording, AS_RECORDED)

    bodies = find_bodies(recording.frame(40), recording.camera, 0.08)
    assert len(bodies.areas) == 2
    assert agreement(actor_only.frame(40) > 0.0, actor.frame(40) > 0.0) > 0.98


def test_two_people_next_to_each_other_are_two_bodies():
    depth = np.zeros((240, 320), dtype=np.float32)
    depth[60:180, 60:100] = depth[60:180, 120:160] = 3.0

    assert len(find_bodies(depth, KINECT, 0.08).areas) == 2


def test_room_whose_floor_is_out_of_view_is_not_the_actor():
    def read(frame: int) -> np.ndarray:
        depth = np.full((240, 320), 4.0, dtype=np.float32)
        depth[60:180, 10 * frame : 10 * frame + 60] = 2.5
        return depth

    found = find_actor(DepthRecording(KINECT, 24, 30.0, read))

    assert found.method is ForegroundMethod.AUTOMATIC
    assert found.recording.frame(12).astype(bool).mean() < 0.2


def test_person_far_from_where_the_actor_is_expected_is_not_the_actor():
    depth = np.zeros((240, 320), dtype=np.float32)
    depth[60:180, 60:100] = 3.0
    alone = DepthRecording(KINECT, 1, 30.0, lambda frame: depth)
    at, elsewhere = np.array([[-0.8, 0.0, 3.0]]), np.array([[1.2, 0.0, 3.0]])

    near, far = (
        cut_out_actor(alone, AS_RECORDED, trajectory=expected).frame(0)
        for expected in (at, elsewhere)
    )

    assert (near > 0.0).sum() == 120 * 40
    assert not far.any()


def test_cut_out_actor_returns_empty_images_without_a_person():
    empty = DepthRecording(KINECT, 2, 30.0, lambda _: np.zeros((240, 320), np.float32))

    assert cut_out_actor(empty).frame(1).max() == 0.0


def test_background_method_raises_without_frames_of_the_empty_room(actor):
    with pytest.raises(InvalidMotionError, match="Select frames without the actor"):
        cut_out_actor(actor, SUBTRACTED)
    with pytest.raises(InvalidMotionError, match="needs at least one frame"):
        learn_background(actor, [])


def test_learn_background_returns_median_and_noise(rng):
    depth = (2.0 + 0.02 * rng.normal(size=(50, 240, 320))).astype(np.float32)
    depth[:30, 0, 0] = 0.0
    depth[:10, 0, 1] = 0.0

    background = learn_background(
        DepthRecording(KINECT, 50, 30.0, lambda frame: depth[frame]), range(50)
    )

    assert background.depth[0, 0] == 0.0
    assert background.depth[0, 1] == pytest.approx(np.median(depth[10:, 0, 1]))
    assert np.median(background.spread) == pytest.approx(0.02, rel=0.05)


def test_actor_on_the_spot_is_no_noise_of_the_wall_behind_him(rng):
    """He sways: one half of the frames shows him, the other half the wall, at each pixel."""
    covers = np.arange(40) % 2 == 0
    images = np.where(covers[:, None, None], 2.0, 4.0) + rng.normal(0.0, 0.02, (40, 6, 6))

    background = uncovered_background(frames_of(images))

    assert background.spread.max() < 0.04
    assert is_in_front(images[0], background, 0.05).all()


@pytest.mark.parametrize(("n_covered", "n_beyond"), [(51, 0), (0, 4)])
def test_room_is_found_behind_long_stays_and_before_outliers(n_covered, n_beyond):
    """In most of 60 frames the actor covers the wall, or a few readings lie behind it."""
    images = np.full((60, 6, 6), 4.0, np.float32)
    images[:n_covered] = 2.0
    images[:n_beyond] = 7.0

    background = uncovered_background(frames_of(images))

    assert_allclose(background.depth, 4.0)


def test_noise_of_a_wall_is_no_actor_and_an_actor_near_it_is(rng):
    """The noise is 2 cm; the actor stands 10 cm in front of the wall."""
    images = 4.0 + rng.normal(0.0, 0.02, (60, 40, 40))
    background = learn_background(frames_of(images), range(60))

    assert is_in_front(images, background, 0.0).mean() < 0.001
    assert is_in_front(images - 0.1, background, 0.0).mean() > 0.8


def frames_of(images):
    camera = Camera(10.0, 10.0, 2.5, 2.5, images.shape[2], images.shape[1])
    return DepthRecording(camera, len(images), 30.0, lambda frame: images[frame])
