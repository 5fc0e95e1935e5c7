"""Rotations agree with SciPy and the laws of rotations, including gaps."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation, Slerp

from solvers.rotations.representations import (
    IDENTITY,
    angle_between,
    euler_from_quaternion,
    inverse,
    matrix_from_quaternion,
    mean_rotation,
    multiply,
    normalize,
    quaternion_from_euler,
    quaternion_from_matrix,
    quaternion_from_rotation_vector,
    rotate,
    rotation_between,
    rotation_vector_from_quaternion,
    slerp,
    twist_about,
    unroll,
    unwrap_euler,
)

ORDERS = ["".join(order) for order in permutations("XYZ")]
VECTORS = arrays(float, 3, elements=st.floats(-3.0, 3.0, allow_subnormal=False))
ROTATIONS = VECTORS.map(quaternion_from_rotation_vector)


@pytest.fixture
def random_rotations(rng) -> np.ndarray:
    """Rotations of every kind, shape (20, 5, 4)."""
    return normalize(rng.normal(size=(20, 5, 4)))


def scipy_of(rotations: np.ndarray) -> Rotation:
    return Rotation.from_quat(np.roll(rotations.reshape(-1, 4), -1, axis=-1))


def test_products_and_rotated_vectors_agree_with_scipy(random_rotations, rng):
    other, vectors = random_rotations[::-1], rng.normal(size=(20, 5, 3))

    product = scipy_of(random_rotations) * scipy_of(other)

    assert_allclose(
        matrix_from_quaternion(random_rotations).reshape(-1, 3, 3),
        scipy_of(random_rotations).as_matrix(),
    )
    assert_allclose(
        matrix_from_quaternion(multiply(random_rotations, other)).reshape(-1, 3, 3),
        product.as_matrix(),
        atol=1e-14,
    )
    assert_allclose(
        rotate(random_rotations, vectors).reshape(-1, 3),
        scipy_of(random_rotations).apply(vectors.reshape(-1, 3)),
    )


def test_long_arrays_are_multiplied_completely(rng):
    """More quaternions than one block holds."""
    a, b = rng.normal(size=(2, 9001, 4))

    assert_allclose(multiply(a, b)[-1], multiply(a[-1], b[-1]))
    assert_allclose(multiply(a, b)[8191:8194], multiply(a[8191:8194], b[8191:8194]))


def test_leading_axes_broadcast(random_rotations):
    assert multiply(random_rotations[0], random_rotations).shape == random_rotations.shape
    assert_allclose(
        multiply(random_rotations[0], random_rotations)[7],
        multiply(random_rotations[0], random_rotations[7]),
    )
    assert_allclose(
        multiply(random_rotations, random_rotations[:, :1])[3, 4],
        multiply(random_rotations[3, 4], random_rotations[3, 0]),
    )


@given(ROTATIONS, ROTATIONS, ROTATIONS)
def test_rotations_form_a_group(a, b, c):
    assert_allclose(multiply(multiply(a, b), c), multiply(a, multiply(b, c)), atol=1e-13)
    assert_allclose(multiply(a, inverse(a)), IDENTITY, atol=1e-13)
    assert_allclose(np.linalg.norm(multiply(a, b)), 1.0)


@given(ROTATIONS, VECTORS, VECTORS)
def test_rotation_keeps_lengths_and_angles(rotation, u, v):
    assert_allclose(rotate(rotation, u) @ rotate(rotation, v), u @ v, atol=1e-11)
    assert_allclose(
        rotate(rotation, np.cross(u, v)),
        np.cross(rotate(rotation, u), rotate(rotation, v)),
        atol=1e-11,
    )


@given(VECTORS)
def test_logarithm_inverts_the_exponential(vector):
    angle = np.linalg.norm(vector)
    back = rotation_vector_from_quaternion(quaternion_from_rotation_vector(vector))

    short = vector if angle <= np.pi else vector * (1 - 2 * np.pi / angle)

    if abs(angle - np.pi) > 1e-6:  # at 180 degrees both signs are right
        assert_allclose(back, short, atol=1e-9)


@pytest.mark.parametrize("angle", [0.0, 1e-300, 1e-12, 0.9e-6, 1.1e-6, 1e-3, np.pi - 1e-9])
def test_exponential_and_logarithm_are_exact_at_every_size(angle):
    axis = np.array([2.0, -1.0, 2.0]) / 3.0

    back = rotation_vector_from_quaternion(quaternion_from_rotation_vector(angle * axis))

    assert_allclose(back, angle * axis, rtol=1e-10, atol=1e-15)


def test_matrix_conversion_is_invertible(random_rotations):
    back = quaternion_from_matrix(matrix_from_quaternion(random_rotations))

    assert angle_between(back, random_rotations).max() < 1e-7
    assert (back[..., 0] >= 0.0).all()


@pytest.mark.parametrize("order", ORDERS)
def test_euler_angles_agree_with_scipy_in_every_order(random_rotations, order):
    angles = euler_from_quaternion(random_rotations, order)

    assert_allclose(
        angles.reshape(-1, 3), scipy_of(random_rotations).as_euler(order), atol=1e-12
    )
    assert angle_between(quaternion_from_euler(angles, order), random_rotations).max() < 1e-7


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("middle", [np.pi / 2, -np.pi / 2, np.pi / 2 - 1e-5])
def test_euler_angles_at_gimbal_lock_give_the_same_rotation(order, middle, rng):
    angles = rng.uniform(-3, 3, size=(10, 3))
    angles[:, 1] = middle
    rotations = quaternion_from_euler(angles, order)

    found = euler_from_quaternion(rotations, order)

    assert angle_between(quaternion_from_euler(found, order), rotations).max() < 1e-6
    if abs(middle) == np.pi / 2:
        assert_allclose(found[:, 2], 0.0)


def test_euler_angles_rotate_about_intrinsic_axes():
    quarter = np.pi / 2

    rotation = quaternion_from_euler([quarter, quarter, 0.0], "ZYX")

    # Z first brings X to Y; the Y axis it moved to -X; about it, Z goes to Y.
    assert_allclose(rotate(rotation, [0.0, 0.0, 1.0]), [0.0, 1.0, 0.0], atol=1e-15)


def test_unwrapped_angles_give_the_same_rotations_without_jumps(rng):
    smooth = np.cumsum(rng.normal(scale=0.15, size=(400, 2, 3)), axis=0)
    rotations = quaternion_from_euler(smooth, "ZYX")

    unwrapped = unwrap_euler(euler_from_quaternion(rotations, "ZYX"))

    assert angle_between(quaternion_from_euler(unwrapped, "ZYX"), rotations).max() < 1e-6
    raw = np.abs(np.diff(euler_from_quaternion(rotations, "ZYX"), axis=0)).max()
    assert np.abs(np.diff(unwrapped, axis=0)).max() < np.pi < raw


def test_unwrapped_angles_are_those_of_a_rotation_past_gimbal_lock():
    """Two turns about the middle axis, whose angle alone changes."""
    smooth = np.linspace([1.4, 0.1, -1.2], [1.4, 4.0 * np.pi, -1.2], 90)
    folded = euler_from_quaternion(quaternion_from_euler(smooth, "ZYX"), "ZYX")

    assert np.abs(np.diff(folded, axis=0)).max() > 3.0
    assert_allclose(unwrap_euler(folded), smooth, atol=1e-9)


def test_unwrapping_skips_gaps():
    angles = np.linspace(0, 4 * np.pi, 40)[:, None] * np.array([1.0, 0.0, 0.0])
    folded = (angles + np.pi) % (2 * np.pi) - np.pi
    folded[10:13] = np.nan

    unwrapped = unwrap_euler(folded)

    assert np.isnan(unwrapped[10:13]).all()
    is_finite = np.isfinite(folded)
    assert_allclose(
        (unwrapped - unwrapped[0])[is_finite], (angles - angles[0])[is_finite], atol=1e-12
    )


def test_unrolled_signs_do_not_jump_over_gaps(rng):
    smooth = quaternion_from_rotation_vector(np.cumsum(rng.normal(scale=0.2, size=(300, 3)), 0))
    signs = rng.choice([-1.0, 1.0], size=(300, 1))
    broken = signs * smooth
    broken[50:53] = np.nan

    result = unroll(broken)

    observed = result[np.isfinite(result).all(axis=-1)]
    assert (np.einsum("fi,fi->f", observed[1:], observed[:-1]) > 0).all()
    assert_allclose(np.abs(result), np.abs(broken))
    assert_allclose(result[0], broken[0])


def test_slerp_agrees_with_scipy(random_rotations):
    start, stop = random_rotations[0], random_rotations[1]
    for pair in range(5):
        reference = Slerp([0.0, 1.0], scipy_of(np.stack([start[pair], stop[pair]])))
        for fraction in (0.0, 0.3, 1.0):
            expected = np.roll(reference(fraction).as_quat(), 1)
            assert angle_between(slerp(start[pair], stop[pair], fraction), expected) < 1e-7


@given(ROTATIONS, ROTATIONS, st.floats(0.0, 1.0))
def test_slerp_is_even_and_takes_the_shortest_path(a, b, fraction):
    complete = angle_between(a, b)

    assert_allclose(angle_between(a, slerp(a, b, fraction)), fraction * complete, atol=1e-6)
    assert angle_between(slerp(a, -b, fraction), slerp(a, b, fraction)) < 1e-6 or complete > 3.1


def test_mean_of_symmetric_rotations_is_the_middle(rng):
    middle = quaternion_from_rotation_vector(np.array([0.4, -1.0, 0.3]))
    offset = quaternion_from_rotation_vector(rng.normal(scale=0.4, size=(30, 3)))
    around = multiply(middle, np.concatenate([offset, -inverse(offset)]))
    with_gap = np.concatenate([around, np.full((1, 4), np.nan)])

    assert angle_between(mean_rotation(with_gap), middle) < 1e-7
    assert_allclose(mean_rotation(np.full((3, 2, 4), np.nan)), np.tile(IDENTITY, (2, 1)))


def test_mean_follows_the_weights():
    two = quaternion_from_rotation_vector(np.array([[0.0, 0, 0], [0.4, 0, 0]]))

    assert_allclose(mean_rotation(two, np.array([1.0, 0.0])), IDENTITY, atol=1e-12)
    rotation = rotation_vector_from_quaternion(mean_rotation(two, np.array([1.0, 3.0])))[0]
    # For small angles the chordal mean is the weighted mean of the angles.
    assert 0.29 < rotation < 0.31


@given(VECTORS, VECTORS)
def test_rotation_between_is_the_shortest_rotation(start, stop):
    lengths = np.linalg.norm(start) * np.linalg.norm(stop)
    if lengths < 1e-6:
        return

    rotation = rotation_between(start, stop)

    brought = rotate(rotation, start) * np.linalg.norm(stop) / np.linalg.norm(start)
    assert_allclose(brought, stop, atol=1e-6)
    angle = np.arctan2(np.linalg.norm(np.cross(start, stop)), start @ stop)
    assert_allclose(angle_between(IDENTITY, rotation), angle, atol=1e-6)


def test_opposite_directions_give_180_degrees_and_zero_identity():
    for axis in np.eye(3):
        rotation = rotation_between(axis, -2.0 * axis)
        assert_allclose(rotate(rotation, axis), -axis, atol=1e-12)
    assert_allclose(rotation_between(np.zeros(3), [1.0, 0, 0]), IDENTITY)


@given(ROTATIONS, VECTORS)
def test_swing_times_twist_is_the_rotation(rotation, axis):
    if np.linalg.norm(axis) < 1e-3:
        return
    axis = axis / np.linalg.norm(axis)

    twist = twist_about(rotation, axis)
    swing = multiply(rotation, inverse(twist))

    assert_allclose(np.linalg.norm(twist), 1.0)
    assert_allclose(rotate(twist, axis), axis, atol=1e-9)
    assert_allclose(swing[1:] @ axis, 0.0, atol=1e-7)


def test_nan_does_not_spread(random_rotations):
    holed = random_rotations.copy()
    holed[3, 2, 1] = np.nan
    for function in (
        inverse, normalize, rotation_vector_from_quaternion, matrix_from_quaternion,
        lambda q: multiply(q, random_rotations), lambda q: rotate(q, np.ones(3)),
        lambda q: euler_from_quaternion(q, "XYZ"),
        lambda q: quaternion_from_matrix(matrix_from_quaternion(q)),
    ):  # fmt: skip
        result = function(holed)
        holes = np.isnan(result).reshape(20, 5, -1).any(axis=-1)
        assert holes[3, 2]
        assert holes.sum() == 1
