"""Rotation vectors follow turns of more than half a revolution."""

import numpy as np
from numpy.testing import assert_allclose

from solvers.rotations.representations import (
    angle_between,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
    unwrap_rotation_vectors,
)


def test_unwrapped_rotation_vectors_follow_three_full_turns():
    angles = np.linspace(0.1, 6.0 * np.pi, 90)
    axis = np.array([0.6, 0.0, 0.8])
    true = angles[:, None, None] * axis
    wrapped = rotation_vector_from_quaternion(quaternion_from_rotation_vector(true))
    wrapped[40:44] = np.nan

    unwrapped = unwrap_rotation_vectors(wrapped)

    observed = np.isfinite(wrapped)
    assert_allclose(unwrapped[observed], true[observed], atol=1e-9)
    assert np.isnan(unwrapped[~observed]).all()


def test_unwrapping_rotation_vectors_changes_no_rotation(rng):
    vectors = 2.0 * rng.normal(size=(50, 4, 3))

    unwrapped = unwrap_rotation_vectors(vectors)

    angles = angle_between(
        quaternion_from_rotation_vector(vectors), quaternion_from_rotation_vector(unwrapped)
    )
    assert_allclose(angles, 0.0, atol=1e-6)


def test_each_unwrapped_vector_is_the_nearest_to_the_one_before(rng):
    vectors = np.cumsum(rng.normal(size=(200, 3)), axis=0)
    wrapped = rotation_vector_from_quaternion(quaternion_from_rotation_vector(vectors))
    wrapped[rng.random(200) < 0.1] = np.nan
    wrapped[rng.random(200) < 0.1] = 0.0

    unwrapped = unwrap_rotation_vectors(wrapped)

    last, observed = None, np.isfinite(wrapped).all(axis=1)
    for before, after in zip(wrapped[observed], unwrapped[observed], strict=True):
        if last is not None and before.any():
            turns = 2.0 * np.pi * np.arange(-60, 61)[:, None] * before / np.linalg.norm(before)
            distances = np.linalg.norm(before + turns - last, axis=1)
            assert_allclose(np.linalg.norm(after - last), distances.min(), atol=1e-9)
        last = after
