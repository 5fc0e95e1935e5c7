"""Joint centers from landmarks: the regressions of the papers, by hand."""

import numpy as np
from numpy.testing import assert_allclose

from solvers.markers.joint_centers import _pelvis
from solvers.markers.solve_skeleton import _extend_to_all_frames


def test_hip_joints_are_those_of_the_regression():
    """Harrington et al. 2007, table 4, for a pelvis 240 mm wide and 150 mm deep."""
    landmarks = {
        "LASI": [[0.12, 0.0, 1.0]], "RASI": [[-0.12, 0.0, 1.0]], "SACR": [[0.0, 0.15, 1.0]],
    }  # fmt: skip
    positions = {}

    axes = _pelvis({name: np.array(at) for name, at in landmarks.items()}, positions)

    assert_allclose(axes[0], np.eye(3), atol=1e-12)
    hip = np.array([79.2 + 7.3, 36.0 + 9.9, 1000.0 - 72.0 - 10.9]) / 1000.0
    assert_allclose(positions["leftUpperLeg"][0], hip, atol=1e-12)
    assert_allclose(positions["rightUpperLeg"][0], hip * [-1.0, 1.0, 1.0], atol=1e-12)


def test_frames_without_a_pose_start_at_the_nearest_one_moved_with_the_markers(rng):
    """One of the three markers is hidden then."""
    rotations = rng.normal(size=(3, 1, 4))
    roots = np.array([[1.0, 0.0, 0.0], [np.nan] * 3, [9.0, 9.0, 9.0]])
    observed = np.tile(rng.normal(size=(3, 3)), (3, 1, 1))
    observed[1] += [0.5, 0.0, -0.25]
    observed[1, 2] = np.nan

    poses = _extend_to_all_frames(rotations, roots, observed)

    assert_allclose(poses.roots[1], [1.5, 0.0, -0.25])
    assert_allclose(poses.rotations[1], rotations[0])
    assert_allclose(poses.roots[[0, 2]], roots[[0, 2]])
