"""Compare vector algebra with other implementations."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from solvers.markers.vectors import (
    frame,
    matrix_from_rotation_vector,
    swing_frames,
)
from solvers.rotations import skew_matrices


@pytest.mark.parametrize(("first", "second"), [(0, 1), (1, 0), (2, 1), (1, 2), (0, 2), (2, 0)])
def test_frames_are_rotations_with_the_requested_axes(rng, first, second):
    along, hint = rng.normal(size=(2, 20, 3))

    axes = frame(first, along, second, hint)

    assert_allclose(np.linalg.det(axes), 1.0)
    assert_allclose(axes @ np.swapaxes(axes, 1, 2), np.broadcast_to(np.eye(3), (20, 3, 3)),
                    atol=1e-12)  # fmt: skip
    assert_allclose(np.cross(axes[:, :, first], along), 0.0, atol=1e-12)
    assert (np.einsum("fi,fi->f", axes[:, :, second], hint) > 0.0).all()


def test_rotations_agree_with_scipy(rng):
    vectors = np.concatenate([rng.normal(size=(20, 3)), np.zeros((1, 3))])

    assert_allclose(
        matrix_from_rotation_vector(vectors),
        Rotation.from_rotvec(vectors).as_matrix(),
        atol=1e-12,
    )


def test_skew_matrix_gives_the_cross_product(rng):
    a, b = rng.normal(size=(2, 20, 3))

    assert_allclose(np.einsum("fij,fj->fi", skew_matrices(a), b), np.cross(a, b))


def test_swing_rotates_the_axis_without_twist(rng):
    axis, onto = np.array([0.0, 0.0, -1.0]), rng.normal(size=(20, 3))

    rotated = swing_frames(np.eye(3), axis, onto)

    assert_allclose(rotated @ axis, onto / np.linalg.norm(onto, axis=1)[:, None], atol=1e-12)
    twist = np.einsum("fi,i->f", Rotation.from_matrix(rotated).as_rotvec(), axis)
    assert_allclose(twist, 0.0, atol=1e-9)
