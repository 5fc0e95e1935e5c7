"""The actor is cut out of each image as it arrives, as from the complete recording."""

from dataclasses import replace

import numpy as np
import pytest
from depth_rooms import in_room, room, tilted
from drawn_bodies import CAMERA, recorded, waving
from numpy.testing import assert_array_equal

from solvers.depth_scene.actor import find_actor
from solvers.depth_scene.causal_actor import CausalActor

N_FRAMES, N_FIRST = 60, 30


@pytest.fixture(scope="module")
def in_a_room():
    poses = waving(N_FRAMES)
    poses[:, 0] = np.linspace(-0.5, 0.5, N_FRAMES)
    return in_room(recorded(poses), room(CAMERA, tilted(0.0), 1.0, 4.5))


def test_later_images_show_the_actor_that_the_complete_recording_shows(in_a_room):
    complete = find_actor(in_a_room).recording
    live = CausalActor(find_actor(replace(in_a_room, n_frames=N_FIRST)))

    for frame in range(N_FIRST, N_FRAMES):
        found, true = live.cut_out(in_a_room.frame(frame)) > 0.0, complete.frame(frame) > 0.0
        assert (found & true).sum() > 0.97 * (found | true).sum()


def test_first_images_are_cut_out_again_from_the_first_position_on():
    """The actor crosses 2.4 m, twice the distance at which a body is another person."""
    poses = waving(N_FRAMES)
    poses[:, 0] = np.linspace(-1.2, 1.2, N_FRAMES)
    alone = recorded(poses)
    live = CausalActor(find_actor(alone), from_start=True)

    for frame in range(N_FRAMES):
        assert_array_equal(live.cut_out(alone.frame(frame)), alone.frame(frame))


def test_recording_of_the_actor_alone_is_unchanged():
    alone = recorded(waving(N_FRAMES))
    live = CausalActor(find_actor(replace(alone, n_frames=N_FIRST)))

    for frame in range(N_FIRST, N_FRAMES, 5):
        assert_array_equal(live.cut_out(alone.frame(frame)), alone.frame(frame))


def test_actor_who_left_may_return_elsewhere():
    poses = waving(N_FIRST)
    poses[:, 0] = -0.7
    alone = recorded(poses)
    live = CausalActor(find_actor(alone))
    far = np.roll(alone.frame(0), 75, axis=1)  # 1.5 m to the right
    assert not live.cut_out(far).any()

    for _ in range(31):
        assert not live.cut_out(np.zeros_like(far)).any()

    assert_array_equal(live.cut_out(far), far)
