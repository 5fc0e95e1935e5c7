"""Standing feet with missing toes are laid flat; others stay as they are."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.feet import find_legs
from solvers.motion import Motion, forward_kinematics
from solvers.rotations import multiply, quaternion_from_rotation_vector
from solvers.samples import walker_skeleton
from solvers.workflows.planting.flatten_toes import DEFAULT_DROP, flatten_toes

N_FRAMES = 60
SKELETON = walker_skeleton()
LEFT = find_legs(SKELETON)[0]


def test_foot_of_missing_toes_is_as_flat_as_by_default():
    standing = with_pitch(np.full(N_FRAMES, 40.0))

    flat = flatten_toes(standing, reliability(0.0), left_contacts())

    foot = foot_of(flat)
    length = np.linalg.norm(foot, axis=1)
    assert_allclose(foot[:, 2], -DEFAULT_DROP * length, atol=1e-9)
    assert_allclose(foot[:, 0], 0.0, atol=1e-6)
    assert (foot[:, 1] < 0.0).all(), "it points where the character faces"


def test_foot_is_as_flat_as_where_its_toes_were_observed():
    """Its toes are missing, and point down, in the second half."""
    pitch = np.where(np.arange(N_FRAMES) < 30, 10.0, 40.0)
    standing = with_pitch(pitch)
    seen = reliability(np.where(np.arange(N_FRAMES) < 30, 1.0, 0.0))

    flat = flatten_toes(standing, seen, left_contacts())

    assert_allclose(foot_of(flat)[40:], np.tile(foot_of(standing)[0], (20, 1)), atol=1e-6)


@pytest.mark.parametrize(("reliable", "stands"), [(1.0, True), (0.0, False)])
def test_reliable_toes_and_lifted_feet_stay_as_they_are(reliable, stands):
    standing = with_pitch(np.full(N_FRAMES, 40.0))

    flat = flatten_toes(standing, reliability(reliable), left_contacts() & stands)

    assert_array_equal(flat.rotations, standing.rotations)


def with_pitch(degrees: np.ndarray) -> Motion:
    """Return a standing body whose left toes point down by these angles from the rest pose."""
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (N_FRAMES, SKELETON.n_joints, 1))
    pitch = quaternion_from_rotation_vector(np.outer(np.radians(degrees), [1.0, 0.0, 0.0]))
    rotations[:, LEFT.ankle] = multiply(pitch, rotations[:, LEFT.ankle])
    return Motion(SKELETON, rotations, np.tile([0.0, 0.0, 1.0], (N_FRAMES, 1)), 30.0)


def foot_of(motion: Motion) -> np.ndarray:
    positions = forward_kinematics(motion).positions
    return positions[:, LEFT.toe] - positions[:, LEFT.ankle]


def reliability(of_left_toes) -> np.ndarray:
    found = np.ones((N_FRAMES, SKELETON.n_joints))
    found[:, LEFT.toe] = of_left_toes
    return found


def left_contacts() -> np.ndarray:
    return np.tile([True, False], (N_FRAMES, 1))
