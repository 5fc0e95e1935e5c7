"""Segment transforms equal those of another implementation; derivatives are exact."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from solvers.depth_tracking.body.coordinates import COORDINATES, ROTATION_AXES
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.segment_kinematics import (
    joint_positions,
    segment_frames,
    segment_twists,
)
from solvers.depth_tracking.body.tables import JOINTS, PARENTS, SEGMENTS


def posed(**coordinates):
    pose = np.zeros(36)
    for name, value in coordinates.items():
        pose[COORDINATES.index(name)] = value
    return pose


def segment_origin(pose, name, body=None):
    body = body or default_body()
    return joint_positions(body, segment_frames(body, pose))[JOINTS.index(name)]


def test_zero_pose_stands_upright():
    body, zeros = default_body(), np.zeros(36)
    assert_allclose(segment_frames(body, zeros)[:, :3, :3], np.tile(np.eye(3), (17, 1, 1)))
    assert (
        segment_origin(zeros, "leftHand")[0]
        > 0.1
        > -0.1
        > segment_origin(zeros, "rightHand")[0]
    )
    assert (
        segment_origin(zeros, "head")[1]
        < segment_origin(zeros, "leftHand")[1]
        < segment_origin(zeros, "leftFoot")[1]
    )
    assert segment_origin(zeros, "leftToes")[2] < segment_origin(zeros, "leftFoot")[2]


@pytest.mark.parametrize(
    ("coordinate", "joint", "axis", "sign"),
    [
        ("leftRadius", "leftHand", 2, -1),  # the elbow bends forward
        ("rightTibia", "rightFoot", 2, 1),  # the knee bends back
        ("leftFemurX", "leftLowerLeg", 2, -1),
        ("leftFemurZ", "leftLowerLeg", 0, 1),
        ("rightFemurZ", "rightLowerLeg", 0, -1),
        ("rightHumerusZ", "rightLowerArm", 0, -1),
        ("leftHumerusX", "leftLowerArm", 2, -1),
        ("leftClavicleZ", "leftUpperArm", 1, -1),  # shrugging
        ("rightClavicleY", "rightUpperArm", 2, -1),
        ("lowerBackX", "neck", 2, -1),  # bowing
        ("headX", "head", 2, 0),
    ],
)
def test_coordinates_rotate_in_the_direction_of_their_limits(coordinate, joint, axis, sign):
    moved = segment_origin(posed(**{coordinate: 0.3}), joint) - segment_origin(
        np.zeros(36), joint
    )

    assert np.sign(np.round(moved[axis], 9)) == sign


def test_segment_frames_match_an_explicit_chain(rng):
    body, pose = default_body(), rng.normal(scale=0.7, size=36)
    frames = segment_frames(body, pose)
    rotations = [Rotation.from_euler("YZX", pose[3:6])]
    origins = [pose[:3]]
    for segment, parent in list(enumerate(PARENTS))[1:]:
        rotated = Rotation.from_rotvec(ROTATION_AXES[segment] @ pose)
        origins.append(origins[parent] + rotations[parent].apply(body.offsets[segment]))
        rotations.append(rotations[parent] * rotated)

    assert_allclose(frames[:, :3, 3], origins, atol=1e-12)
    assert_allclose(frames[:, :3, :3], [r.as_matrix() for r in rotations], atol=1e-12)


def test_batched_poses_equal_single_poses(rng):
    body, poses = default_body(), rng.normal(size=(2, 3, 36))
    separate = [[segment_frames(body, pose) for pose in row] for row in poses]

    together = segment_frames(body, poses)

    assert_allclose(together, separate, atol=1e-12)
    assert joint_positions(body, together).shape == (2, 3, len(JOINTS), 3)


@pytest.mark.parametrize("scale", [0.0, 1e-5, 0.6, 2.0])
def test_derivative_equals_central_differences(rng, scale):
    """Move a point fixed to each segment by every coordinate."""
    body, step = default_body(), 1e-6
    pose = rng.normal(scale=scale, size=36) if scale else np.zeros(36)
    pose[:3] = (0.3, -0.2, 3.0)
    local = rng.normal(scale=0.2, size=(17, 3))

    def points(q):
        frames = segment_frames(body, q)
        return np.einsum("sij,sj->si", frames[:, :3, :3], local) + frames[:, :3, 3]

    differences = np.stack(
        [(points(pose + step * e) - points(pose - step * e)) / (2 * step) for e in np.eye(36)],
        axis=-1,
    )
    twists = segment_twists(pose, segment_frames(body, pose))
    moved = np.cross(twists[:, :3], points(pose)[:, :, None], axis=1) + twists[:, 3:]

    assert_allclose(moved, differences, atol=2e-8)


def test_segment_frames_are_periodic_in_yaw(rng):
    body, pose = default_body(), rng.normal(scale=0.4, size=36)
    rotated = pose.copy()
    rotated[COORDINATES.index("yaw")] += 2 * np.pi

    assert_allclose(segment_frames(body, rotated), segment_frames(body, pose), atol=1e-12)


def test_lower_back_flexes_spine_and_chest_by_half_each():
    body = default_body()
    frames = segment_frames(body, posed(lowerBackY=0.8))
    angles = Rotation.from_matrix(frames[:3, :3, :3]).magnitude()

    assert_allclose(angles, [0.0, 0.4, 0.8], atol=1e-12)
    assert SEGMENTS[:3] == ("hips", "spine", "chest")
