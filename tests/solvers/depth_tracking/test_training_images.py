"""Training poses and images are diverse, plausible, clothed and reproducible."""

from dataclasses import replace

import numpy as np
import pytest
from box_person import box_person

from solvers.depth_tracking.forest.parts import MIRRORED_PARTS, PARTS
from solvers.depth_tracking.forest_training.augmented_poses import (
    PoseMixer,
    remove_heading,
    select_diverse_poses,
)
from solvers.depth_tracking.forest_training.render_mesh import NO_PART
from solvers.depth_tracking.forest_training.training_images import (
    CAMERA,
    IMAGES_PER_BODY,
    TrainingImagesSettings,
    image_source,
    vary_body,
)
from solvers.errors import InvalidMotionError, InvalidSettingError
from solvers.motion import Skeleton, world_poses
from solvers.rotations.representations import (
    IDENTITY,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)
from solvers.samples import GaitSettings, walking_gait

PLAIN = TrainingImagesSettings(
    loose=0.0,
    noise=0.0,
    shape=0.0,
    clothes=0.0,
    missing_feet=0.0,
    min_distance=2.5,
    max_distance=3.0,
)


@pytest.fixture(scope="module")
def person():
    return box_person()


@pytest.fixture(scope="module")
def gait():
    return walking_gait(GaitSettings(duration=2.0, frame_rate=20.0))


def test_poses_without_heading_stay_upright(person, rng):
    rotations = quaternion_from_rotation_vector(
        rng.normal(size=(20, person.skeleton.n_joints, 3))
    )
    upright = remove_heading(rotations)
    np.testing.assert_array_equal(upright[:, 1:], rotations[:, 1:])
    up = rotate(rotations[:, 0], [0.0, 0.0, 1.0])
    np.testing.assert_allclose(rotate(upright[:, 0], [0.0, 0.0, 1.0])[:, 2], up[:, 2])
    spun = rotations.copy()
    spun[:, 0] = multiply(quaternion_from_rotation_vector([0.0, 0.0, 1.3]), rotations[:, 0])
    same = np.abs(np.einsum("fi,fi->f", remove_heading(spun)[:, 0], upright[:, 0]))
    np.testing.assert_allclose(same, 1.0)


def test_selected_poses_differ_and_cover_the_rest(person, gait):
    poses = remove_heading(person.rotations_of(gait))
    selected = select_diverse_poses(person, poses, 0.15, 1000)
    assert 3 < len(selected) < len(poses)

    def joints(rotations):
        return world_poses(person.skeleton, rotations, np.zeros((len(rotations), 3))).positions

    distances = np.linalg.norm(joints(selected)[:, None] - joints(selected), axis=-1).max(
        axis=-1
    )
    assert distances[~np.eye(len(selected), dtype=bool)].min() > 0.15
    to_selected = np.linalg.norm(joints(poses)[:, None] - joints(selected), axis=-1).max(
        axis=-1
    )
    assert to_selected.min(axis=1).max() <= 0.15 + 1e-6
    assert len(select_diverse_poses(person, poses, 0.0, 7)) == 7


def test_random_arms_avoid_the_back_and_flex_forward(person, rng):
    n_joints = person.skeleton.n_joints
    mixer = PoseMixer(person, np.tile(IDENTITY, (1, n_joints, 1)))
    joints = person.humanoid.indices(person.skeleton)
    for _ in range(60):
        pose = mixer.draw(rng, 1.0)
        np.testing.assert_allclose(np.linalg.norm(pose, axis=-1), 1.0)
        for side, sign in (("left", 1.0), ("right", -1.0)):
            direction = rotate(pose[joints[f"{side}UpperArm"]], [sign, 0.0, 0.0])
            assert direction[0] * sign >= -0.36
            assert direction[1] <= 0.36
            forearm = rotate(pose[joints[f"{side}LowerArm"]], [sign, 0.0, 0.0])
            assert forearm[1] <= 1e-9
            shin = rotate(pose[joints[f"{side}LowerLeg"]], [0.0, 0.0, -1.0])
            assert shin[1] >= -1e-9


def test_poses_without_randomization_equal_those_of_the_clip(person, rng):
    rotations = quaternion_from_rotation_vector(
        rng.normal(size=(5, person.skeleton.n_joints, 3))
    )
    mixer = PoseMixer(person, rotations)
    for _ in range(10):
        pose = mixer.draw(rng, 0.0)
        assert (np.abs(rotations - pose).max(axis=(1, 2)) == 0.0).any()


def test_images_are_determined_by_their_block(person, gait):
    settings = TrainingImagesSettings()
    one, again = (image_source([gait], [person], settings, 3) for _ in range(2))
    other = image_source([gait], [person], settings, 4)
    first, second, third = (source.render(2) for source in (one, again, other))
    assert len(first) == IMAGES_PER_BODY
    np.testing.assert_array_equal(first[4].depth, second[4].depth)
    assert not np.array_equal(first[4].depth, third[4].depth)
    assert not np.array_equal(first[4].depth, one.render(3)[4].depth)


def test_bodies_are_within_the_distances_of_the_settings(person, gait):
    source = image_source([gait], [person], PLAIN, 0)
    for image in source.render(0) + source.render(1):
        observed = image.depth > 0
        assert observed.sum() > 300
        np.testing.assert_array_equal(observed, image.labels != NO_PART)
        assert 2.0 < np.median(image.depth[observed]) < 3.5
        assert image.depth.shape == (CAMERA.height, CAMERA.width)


def test_feet_are_removed_with_the_requested_frequency(person, gait):
    foot = [PARTS.index("leftFoot"), PARTS.index("rightFoot")]

    def feet(missing):
        source = image_source([gait], [person], replace(PLAIN, missing_feet=missing), 0)
        images = source.render(0) + source.render(1)
        return sum(np.isin(image.labels, foot).sum() for image in images)

    assert feet(1.0) < 0.7 * feet(0.0)


def test_clothes_expand_the_body_symmetrically(person, rng):
    naked = vary_body([person], rng, PLAIN)
    np.testing.assert_allclose(naked.vertices, person.vertices)
    dressed = vary_body([person], rng, replace(PLAIN, clothes=0.04))
    moved = dressed.vertices - person.vertices
    out = np.einsum("vi,vi->v", moved, person.vertex_normals)
    assert out.min() >= -1e-9
    assert out.max() <= 0.04 + 1e-9
    thickness = np.array([np.median(out[person.vertex_parts == p]) for p in range(len(PARTS))])
    np.testing.assert_allclose(thickness, thickness[MIRRORED_PARTS], atol=1e-9)


def test_blended_bodies_have_blended_bones(person, rng):
    tall = replace(
        person,
        vertices=1.2 * person.vertices,
        skeleton=Skeleton(
            person.skeleton.names, person.skeleton.parents, 1.2 * person.skeleton.offsets
        ),
    )
    heights = [vary_body([person, tall], rng, PLAIN).skeleton.offsets[0, 2] for _ in range(40)]
    assert min(heights) >= 0.95 - 1e-9
    assert max(heights) <= 1.2 * 0.95 + 1e-9
    assert len(np.unique(np.round(heights, 6))) > 10


def test_normals_point_outwards(person):
    boxes = person.vertices.reshape(-1, 8, 3)
    out = boxes - boxes.mean(axis=1, keepdims=True)
    normals = person.vertex_normals.reshape(-1, 8, 3)
    assert (np.einsum("bvi,bvi->bv", out, normals) > 0.0).all()
    np.testing.assert_allclose(np.linalg.norm(normals, axis=-1), 1.0)


def test_bodies_with_other_joints_cannot_be_blended(person, gait):
    names = tuple(f"{name}_" for name in person.skeleton.names)
    skeleton = Skeleton(names, person.skeleton.parents, person.skeleton.offsets)
    other = replace(person, skeleton=skeleton)
    with pytest.raises(InvalidMotionError, match="the same joints"):
        image_source([gait], [person, other], PLAIN, 0)
    with pytest.raises(InvalidSettingError, match="loose"):
        TrainingImagesSettings(loose=2.0)
