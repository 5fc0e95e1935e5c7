"""Feet that move in a contact that is detected are held as far as leg and body allow."""

import numpy as np
import pytest

from solvers.feet import plant_feet
from solvers.feet.legs import find_legs
from solvers.feet.plant_in_window import MAX_CHANGE_RAD, MAX_ROOT_CHANGE_M
from solvers.motion import Motion, forward_kinematics
from solvers.rotations.representations import (
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
)
from solvers.samples import GaitSettings, walking_gait

RATE = 60.0


@pytest.fixture
def standing(rng) -> Motion:
    """An actor who stands, and trembles, for three seconds."""
    walk = walking_gait(GaitSettings(duration=1.0, frame_rate=RATE))
    feet = forward_kinematics(walk).positions[
        :, [leg.ankle for leg in find_legs(walk.skeleton)]
    ]
    both_down = int(np.argmin(np.ptp(feet[:, :, 2], axis=1) + feet[:, :, 2].max(axis=1)))
    n_frames = round(3.0 * RATE)
    roots = np.repeat(walk.root_positions[[both_down]], n_frames, axis=0)
    rotations = np.repeat(walk.rotations[[both_down]], n_frames, axis=0)
    tremble = quaternion_from_rotation_vector(
        0.002 * rng.normal(size=(*rotations.shape[:2], 3))
    )
    return Motion(walk.skeleton, multiply(rotations, tremble), roots, RATE)


def changes(before: Motion, after: Motion) -> tuple[float, float]:
    """Return the largest rotation of a joint, radians, and of the root's position, meters."""
    turned = angle_between(before.rotations, after.rotations).max()
    moved = np.linalg.norm(after.root_positions - before.root_positions, axis=1).max()
    return float(turned), float(moved)


def largest_speed(motion: Motion) -> float:
    """Return the largest speed of an ankle, meters per second."""
    ankles = [leg.ankle for leg in find_legs(motion.skeleton)]
    steps = np.diff(forward_kinematics(motion).positions[:, ankles], axis=0)
    return float(np.linalg.norm(steps, axis=2).max() * RATE)


def test_body_that_glides_is_not_pulled_back_and_its_feet_do_not_jump(standing):
    seconds = np.arange(standing.n_frames) / RATE
    glide = 0.5 * np.clip(seconds - 1.0, 0.0, 1.0)
    roots = standing.root_positions + glide[:, None] * (0.0, 1.0, 0.0)
    source = standing.with_poses(root_positions=roots)

    detected = plant_feet(source)
    keyed = plant_feet(source, detected.all_contacts)

    assert detected.contacts.mean() > 0.9
    assert changes(source, keyed.motion)[1] > 1.5 * MAX_ROOT_CHANGE_M
    assert changes(source, detected.motion)[1] < 1.2 * MAX_ROOT_CHANGE_M
    assert largest_speed(detected.motion) < 1.3 * largest_speed(source)


def test_glitch_of_one_frame_does_not_twist_a_leg(standing):
    rotations = standing.rotations.copy()
    glitch = quaternion_from_rotation_vector(np.radians([20.0, 0.0, 0.0]))
    rotations[90, 0] = multiply(rotations[90, 0], glitch)
    source = standing.with_poses(rotations)

    detected = plant_feet(source)
    keyed = plant_feet(source, detected.all_contacts)

    assert detected.contacts[85:95].all()
    assert changes(source, keyed.motion)[0] > 2.0 * MAX_CHANGE_RAD
    assert changes(source, detected.motion)[0] < 1.5 * MAX_CHANGE_RAD


def test_feet_that_can_be_held_are_held_as_if_keyed(standing):
    sway = 0.02 * np.sin(2.0 * np.pi * np.arange(standing.n_frames) / RATE)
    source = standing.with_poses(
        root_positions=standing.root_positions + sway[:, None] * (1.0, 0.0, 0.0)
    )

    detected = plant_feet(source)
    keyed = plant_feet(source, detected.all_contacts)

    assert detected.contacts.all()
    assert (detected.motion.rotations == keyed.motion.rotations).all()


def test_only_the_contact_that_is_keyed_does_not_yield(standing):
    """The body glides in two contacts; one frame of the first is keyed."""
    seconds = np.arange(2 * standing.n_frames) / RATE
    glide = 0.5 * (np.clip(seconds - 1.0, 0.0, 1.0) + np.clip(seconds - 4.0, 0.0, 1.0))
    rotations = np.tile(standing.rotations, (2, 1, 1))
    roots = np.tile(standing.root_positions, (2, 1)) + glide[:, None] * (0.0, 1.0, 0.0)
    source = standing.with_poses(rotations, roots)
    given = np.full((len(seconds), 2), np.nan)
    given[round(2.9 * RATE) : round(3.1 * RATE)] = 0.0
    given[round(1.5 * RATE)] = 1.0

    planted = plant_feet(source, given)

    first, second = (slice(round(s * RATE), round((s + 1.0) * RATE)) for s in (1, 4))
    ankles = [leg.ankle for leg in find_legs(source.skeleton)]
    paths = forward_kinematics(planted.motion).positions[:, ankles, 1]
    assert planted.contacts[first].all() and planted.contacts[second].all()
    assert np.ptp(paths[first], axis=0).max() < 0.05
    assert np.ptp(paths[second], axis=0).min() > 0.2
