"""A foot that is dragged over the floor is not planted; one that slides by mistake is."""

import numpy as np
import pytest

from solvers.feet import plant_feet
from solvers.feet.dragged_feet import find_dragged_feet
from solvers.feet.legs import find_legs
from solvers.motion import Motion, detect_contacts, forward_kinematics
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait
from tests.benchmarks.contacts.made_drags import made_drags
from tests.benchmarks.contacts.made_takes import made_takes
from tests.benchmarks.contacts.part_takes import INPUTS

SHUFFLE = made_drags(60.0)["30 cm at 0.3 m/s"]
SPOILED = [name for name in INPUTS if name != "as they are"]


def dragged(motion: Motion) -> np.ndarray:
    return find_dragged_feet(motion, find_legs(motion.skeleton), detect_contacts(motion))


def ankle_paths(motion: Motion) -> np.ndarray:
    ankles = [leg.ankle for leg in find_legs(motion.skeleton)]
    return forward_kinematics(motion).positions[:, ankles]


@pytest.mark.parametrize("rate", [30.0, 60.0, 120.0])
def test_dragged_foot_is_found_at_all_frame_rates(rate):
    take = made_drags(rate)["30 cm at 0.3 m/s"]

    found = dragged(take.motion)

    assert found[~take.contacts].mean() > 0.9
    assert found[take.contacts].mean() < 0.01


@pytest.mark.parametrize("spoiled", SPOILED)
def test_error_of_the_path_is_no_drag(spoiled):
    """A root that jitters, or travels too far, moves both feet."""
    found = dragged(INPUTS[spoiled](SHUFFLE.motion))

    assert found[~SHUFFLE.contacts].mean() > 0.8
    assert found[SHUFFLE.contacts].mean() < 0.01


@pytest.mark.parametrize("name", made_takes(60.0))
def test_steps_and_stances_are_no_drags(name):
    take = made_takes(60.0)[name]

    assert not dragged(take.motion).any()
    for spoiled in SPOILED:
        assert dragged(INPUTS[spoiled](take.motion))[take.contacts].mean() < 0.02


@pytest.mark.parametrize("degrees", [1.0, 3.0])
def test_jitter_of_joints_is_no_drag(degrees):
    walk = walking_gait(GaitSettings(duration=6.0, frame_rate=30.0))
    for motion in (walk, made_takes(60.0)["stand and sway"].motion, SHUFFLE.motion):
        settings = CorruptionSettings(jitter=degrees, root_jitter=0.002 * degrees, seed=3)
        assert not dragged(corrupt(motion, settings)).any()


def test_dragged_foot_keeps_its_path_and_the_other_one_stands():
    planted = plant_feet(SHUFFLE.motion)

    before, after = ankle_paths(SHUFFLE.motion), ankle_paths(planted.motion)
    assert np.linalg.norm(after - before, axis=2).max() < 0.03
    assert (planted.contacts == SHUFFLE.contacts).mean() > 0.97
    assert planted.slide_after < 0.01


def test_dragged_foot_is_held_if_its_contact_is_keyed():
    planted = plant_feet(SHUFFLE.motion, np.ones((SHUFFLE.motion.n_frames, 2), np.bool_))

    assert np.ptp(ankle_paths(planted.motion)[..., 1], axis=0).max() < 0.1


def test_one_leg_alone_drags_nothing():
    legs = find_legs(SHUFFLE.motion.skeleton)[:1]

    assert not find_dragged_feet(SHUFFLE.motion, legs, detect_contacts(SHUFFLE.motion)).any()
