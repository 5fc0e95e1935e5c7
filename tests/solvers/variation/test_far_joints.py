"""Joints that turn far are told about what the centre's do at the same moment."""

import numpy as np
from numpy.testing import assert_allclose

from solvers.rotations.representations import (
    IDENTITY,
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
)
from solvers.variation import (
    VarySettings,
    draw_variants,
    learn_variation_model,
    load_variation_model,
    synthesize,
)
from solvers.variation.far_joints import tell_far_joints

N = 60


def windmill(turns, extra=0.0):
    angles = np.linspace(0.0, 2.0 * np.pi * turns, N) + extra
    return quaternion_from_rotation_vector(angles[:, None] * np.array([1.0, 0.0, 0.0]))


def far(is_loop=False):
    """Two joints: one stands still, one goes round twice, half a radian ahead in the second."""
    still = np.tile(IDENTITY, (N, 1))
    plain = [np.stack([still, windmill(2, extra)], axis=1) for extra in (0.0, 0.5)]
    joints = np.stack([rotation_vector_from_quaternion(one) for one in plain])
    usual = np.tile(IDENTITY, (2, 1))
    times = np.tile(np.arange(N, dtype=float), (2, 1))
    return plain, tell_far_joints(joints, usual, plain, times, 0, 2.0, is_loop)


def test_half_a_radian_ahead_is_half_a_radian_at_all_times():
    _, (joints, usual, carrier) = far()

    assert_allclose(joints[1, 10:-10, 1], [[0.5, 0.0, 0.0]] * (N - 20), atol=1e-3)
    assert_allclose(joints[0, 10:-10, 1], 0.0, atol=1e-3)
    assert_allclose(carrier[:, 0], np.tile(IDENTITY, (N, 1)))
    assert_allclose(usual[1], IDENTITY)


def test_carrier_and_vector_together_are_the_rotation():
    plain, (joints, usual, carrier) = far()
    for example, vectors in zip(plain, joints, strict=True):
        told = multiply(carrier, multiply(usual, quaternion_from_rotation_vector(vectors)))
        apart = rotation_vector_from_quaternion(multiply(inverse(told), example))
        assert_allclose(np.linalg.norm(apart, axis=-1) % (2.0 * np.pi), 0.0, atol=1e-6)


def test_of_a_loop_the_carrier_goes_on_at_the_other_end():
    """Two whole rounds end as they begin: no shrinking towards the ends."""
    _, (joints, _, carrier) = far(is_loop=True)
    assert_allclose(joints[0, :, 1], 0.0, atol=1e-3)
    ends = np.abs(np.sum(carrier[0, 1] * carrier[-1, 1]))
    assert_allclose(ends, 1.0, atol=1e-6)


def test_what_stays_near_is_told_as_before(walks):
    assert learn_variation_model(walks).carrier is None


def test_a_copy_of_a_windmill_is_the_windmill_and_a_file_keeps_it(walks, tmp_path):
    place = walks[0].skeleton.names.index("LeftArm")
    mills = []
    for walk in walks[:3]:
        rotations = walk.rotations.copy()
        angles = np.linspace(0.0, 4.0 * np.pi, walk.n_frames)
        turn = quaternion_from_rotation_vector(angles[:, None] * np.array([1.0, 0.0, 0.0]))
        rotations[:, place] = multiply(turn, rotations[:, place])
        mills.append(walk.with_poses(rotations))
    model = learn_variation_model(mills)

    copy = draw_variants(model, 1, settings=VarySettings(amount=0.0))[0].motion

    own = mills[model.centre].rotations
    assert_allclose(np.abs(np.sum(copy.rotations[:, 1:] * own[:, 1:], axis=-1)), 1.0, atol=1e-6)
    model.save(tmp_path / "mills.npz")
    again = synthesize(load_variation_model(tmp_path / "mills.npz"), 1)[0]
    assert_allclose(again.rotations, synthesize(model, 1)[0].rotations, atol=1e-9)


def test_about_what_flips_nothing_is_told():
    plain, _ = far()
    plain[0][30:35, 1] = multiply(plain[0][30:35, 1], [0.0, 0.0, 0.0, 1.0])
    joints = np.stack([rotation_vector_from_quaternion(one) for one in plain])
    times = np.tile(np.arange(N, dtype=float), (2, 1))
    usual = np.tile(IDENTITY, (2, 1))

    told, _, carrier = tell_far_joints(joints, usual, plain, times, 0, 2.0, False)

    assert carrier is None
    assert_allclose(told, joints)
