"""The heading follows the actor, not left-right swaps of a tracker."""

import kinect_walks
import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers import samples
from solvers.motion.humanoid import posture_joints
from solvers.motion.humanoid.posture_heading import normalize_postures, rotate_about_vertical
from solvers.motion.humanoid.posture_joints import MIRROR_JOINTS


@pytest.fixture(scope="module")
def walk():
    return kinect_walks.true_positions(samples, posture_joints)


def headings(postures):
    return np.unwrap(normalize_postures(postures, 30.0).headings)


@pytest.mark.parametrize("n_frames", [1, 5, 10])
def test_left_right_swaps_do_not_change_the_heading(walk, n_frames):
    corrupted = walk.copy()
    corrupted[40 : 40 + n_frames] = corrupted[40 : 40 + n_frames][:, list(MIRROR_JOINTS)]

    assert_allclose(headings(corrupted), headings(walk), atol=np.radians(3.0))


@pytest.mark.parametrize("rotations_per_second", [0.5, 1.0, 2.0])
def test_heading_of_a_spinning_actor_is_followed(walk, rotations_per_second):
    angles = 2.0 * np.pi * rotations_per_second * np.arange(len(walk)) / 30.0
    middle = slice(10, -10)  # smoothing shortens the ends

    found = headings(rotate_about_vertical(walk, angles)) - headings(walk)

    differences = found - angles
    assert_allclose(differences[middle], differences[middle].mean(), atol=np.radians(4.0))
    assert np.cos(differences[middle]).min() > 0.99


def test_rotation_by_180_degrees_in_a_third_second_is_followed(walk):
    angles = np.pi * np.clip((np.arange(len(walk)) - 40.0) / 10.0, 0.0, 1.0)

    found = headings(rotate_about_vertical(walk, angles)) - headings(walk)

    assert np.abs(found - angles).max() < np.radians(25.0)  # smoothed over a tenth of a second
    assert np.abs(found - angles)[[30, 60]].max() < np.radians(2.0)
