"""Wide-ranging joints are relative to the center's rotation at the same time."""

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
    learn_variation_model,
    load_variation_model,
    synthesize,
)
from solvers.variation.moving_references import split_moving_references

N_FRAMES = 60


def windmill(n_rotations, extra=0.0):
    angles = np.linspace(0.0, 2.0 * np.pi * n_rotations, N_FRAMES) + extra
    return quaternion_from_rotation_vector(angles[:, None] * np.array([1.0, 0.0, 0.0]))


def build_windmills(is_loop=False):
    """Return two examples of two joints: one at rest, one rotating twice."""
    still = np.tile(IDENTITY, (N_FRAMES, 1))
    rotations = [np.stack([still, windmill(2, extra)], axis=1) for extra in (0.0, 0.5)]
    joints = np.stack([rotation_vector_from_quaternion(one) for one in rotations])
    reference_rotations = np.tile(IDENTITY, (2, 1))
    times = np.tile(np.arange(N_FRAMES, dtype=float), (2, 1))
    return rotations, split_moving_references(
        joints, reference_rotations, rotations, times, 0, 2.0, is_loop
    )


def test_constant_offset_is_a_constant_vector():
    _, (joints, reference_rotations, moving_references) = build_windmills()

    assert_allclose(joints[1, 10:-10, 1], [[0.5, 0.0, 0.0]] * (N_FRAMES - 20), atol=1e-3)
    assert_allclose(joints[0, 10:-10, 1], 0.0, atol=1e-3)
    assert_allclose(moving_references[:, 0], np.tile(IDENTITY, (N_FRAMES, 1)))
    assert_allclose(reference_rotations[1], IDENTITY)


def test_reference_and_vector_compose_to_the_rotation():
    rotations, (joints, reference_rotations, moving_references) = build_windmills()
    for example, vectors in zip(rotations, joints, strict=True):
        rebuilt = multiply(
            moving_references,
            multiply(reference_rotations, quaternion_from_rotation_vector(vectors)),
        )
        error = rotation_vector_from_quaternion(multiply(inverse(rebuilt), example))
        assert_allclose(np.linalg.norm(error, axis=-1) % (2.0 * np.pi), 0.0, atol=1e-6)


def test_moving_reference_of_a_loop_is_periodic():
    """Two full rotations end as they start: smoothing does not shrink them at the ends."""
    _, (joints, _, moving_references) = build_windmills(is_loop=True)
    assert_allclose(joints[0, :, 1], 0.0, atol=1e-3)
    ends = np.abs(np.sum(moving_references[0, 1] * moving_references[-1, 1]))
    assert_allclose(ends, 1.0, atol=1e-6)


def test_narrow_joints_need_no_moving_reference(model):
    assert model.moving_references is None


def test_windmill_survives_copying_and_saving(walks, tmp_path):
    index = walks[0].skeleton.names.index("LeftArm")
    mills = []
    for walk in walks[:3]:
        rotations = walk.rotations.copy()
        angles = np.linspace(0.0, 4.0 * np.pi, walk.n_frames)
        rotation = quaternion_from_rotation_vector(angles[:, None] * np.array([1.0, 0.0, 0.0]))
        rotations[:, index] = multiply(rotation, rotations[:, index])
        mills.append(walk.with_poses(rotations))
    model = learn_variation_model(mills)

    (copy,) = synthesize(model, 1, settings=VarySettings(amount=0.0), planting=None)

    own = mills[model.center].rotations
    assert_allclose(np.abs(np.sum(copy.rotations[:, 1:] * own[:, 1:], axis=-1)), 1.0, atol=1e-6)
    model.save(tmp_path / "mills.npz")
    again, first = (
        synthesize(each, 1, planting=None)[0]
        for each in (load_variation_model(tmp_path / "mills.npz"), model)
    )
    assert_allclose(again.rotations, first.rotations, atol=1e-9)


def test_flipping_joint_gets_no_moving_reference():
    rotations, _ = build_windmills()
    rotations[0][30:35, 1] = multiply(rotations[0][30:35, 1], [0.0, 0.0, 0.0, 1.0])
    joints = np.stack([rotation_vector_from_quaternion(one) for one in rotations])
    times = np.tile(np.arange(N_FRAMES, dtype=float), (2, 1))
    reference_rotations = np.tile(IDENTITY, (2, 1))

    rebuilt, _, moving_references = split_moving_references(
        joints, reference_rotations, rotations, times, 0, 2.0, False
    )

    assert moving_references is None
    assert_allclose(rebuilt, joints)
