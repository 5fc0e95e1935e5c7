"""A foot that stood before and after its leg was missing stands meanwhile; others do not."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.denoising import denoise
from solvers.denoising.limb_gaps import keep_standing_feet
from solvers.feet import find_legs
from solvers.motion import Motion
from solvers.motion.skeletons import forward_kinematics, reach
from solvers.rotations import IDENTITY
from solvers.samples import walker_skeleton

RATE, N_FRAMES, GAP = 30.0, 90, slice(30, 60)
SKELETON = walker_skeleton()
LEG = find_legs(SKELETON)[1]


def _squat(depth, ankle_paths=(0.0, 0.0)):
    """Sink by a depth and rise; meters by which the ankles have moved, each frame."""
    rest = SKELETON.rest_positions
    time = np.arange(N_FRAMES) / (N_FRAMES - 1.0)
    roots = np.tile(rest[0], (N_FRAMES, 1))
    roots[:, 2] -= 0.03 + depth * np.sin(np.pi * time) ** 2
    rotations = np.tile(IDENTITY, (N_FRAMES, SKELETON.n_joints, 1)).astype(float)
    motion = Motion(SKELETON, rotations, roots, RATE)
    for leg, path in zip(find_legs(SKELETON), ankle_paths, strict=True):
        targets = np.tile(rest[leg.ankle], (N_FRAMES, 1)) + np.broadcast_to(
            np.asarray(path).reshape(-1, 1) * [0.0, -1.0, 0.0], (N_FRAMES, 3)
        )
        motion = reach(motion, leg.chain, targets)
    return motion


def _without_leg(motion, frames):
    rotations = motion.rotations.copy()
    rotations[frames, SKELETON.subtree(LEG.hip)] = np.nan
    return motion.with_poses(rotations)


def _straight_in_gap(motion, frames):
    """A leg without any knowledge of the floor."""
    rotations = motion.rotations.copy()
    rotations[frames, SKELETON.subtree(LEG.hip)] = IDENTITY
    return motion.with_poses(rotations)


def _ankle(motion):
    return forward_kinematics(motion).positions[:, LEG.ankle]


def test_lost_leg_of_a_squat_stays_on_the_floor():
    truth = _squat(0.4)

    cleaned = denoise(_without_leg(truth, GAP)).recording

    world = forward_kinematics(cleaned)
    place = np.linalg.norm(_ankle(cleaned) - _ankle(truth), axis=1)
    assert place[GAP].max() < 0.02
    knee = world.positions[GAP, LEG.knee] - forward_kinematics(truth).positions[GAP, LEG.knee]
    assert np.linalg.norm(knee, axis=1).max() < 0.1


def test_foot_that_did_not_move_at_all_keeps_its_place():
    truth = _squat(0.4)
    observed = np.isfinite(_without_leg(truth, GAP).rotations).all(axis=2)

    kept = keep_standing_feet(_straight_in_gap(truth, GAP), observed)

    assert_allclose(_ankle(kept)[GAP], _ankle(truth)[GAP], atol=2e-3)
    assert_array_equal(kept.rotations[observed], truth.rotations[observed])


@pytest.mark.parametrize("moved", ["away", "swings"])
def test_foot_that_moves_keeps_its_prediction(moved):
    time = np.arange(N_FRAMES) / RATE
    path = 1.0 * time if moved == "away" else 0.25 * np.sin(2.0 * np.pi * time)
    predicted = _straight_in_gap(_squat(0.1, (0.0, path)), GAP)
    observed = np.isfinite(_without_leg(predicted, GAP).rotations).all(axis=2)

    kept = keep_standing_feet(predicted, observed)

    assert np.linalg.norm(_ankle(kept) - _ankle(predicted), axis=1).max() < 0.02


@pytest.mark.parametrize("frames", [slice(0, 30), slice(60, N_FRAMES), slice(30, 34)])
def test_gap_at_an_end_or_short_one_is_left_alone(frames):
    predicted = _straight_in_gap(_squat(0.4), frames)
    observed = np.isfinite(_without_leg(predicted, frames).rotations).all(axis=2)

    assert_array_equal(keep_standing_feet(predicted, observed).rotations, predicted.rotations)


def test_joint_that_was_observed_in_the_gap_is_left_alone():
    """A leg without its knee alone has a hip that was recorded."""
    predicted = _straight_in_gap(_squat(0.4), GAP)
    observed = np.ones((N_FRAMES, SKELETON.n_joints), dtype=bool)
    observed[GAP, LEG.knee] = False

    assert_array_equal(keep_standing_feet(predicted, observed).rotations, predicted.rotations)


def test_size_of_the_body_does_not_matter():
    truth = _squat(0.4, (0.0, 0.1 * np.arange(N_FRAMES) / N_FRAMES))
    predicted = _straight_in_gap(truth, GAP)
    observed = np.isfinite(_without_leg(truth, GAP).rotations).all(axis=2)
    giant = Motion(
        replace(SKELETON, offsets=10.0 * SKELETON.offsets),
        predicted.rotations,
        10.0 * predicted.root_positions,
        RATE,
    )

    kept, of_giant = (keep_standing_feet(each, observed) for each in (predicted, giant))

    assert_allclose(of_giant.rotations, kept.rotations, atol=1e-9)
    assert np.abs(kept.rotations - predicted.rotations).max() > 0.1
