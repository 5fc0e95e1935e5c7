"""A skeleton follows tracked joints, measured by forward kinematics."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from solvers.errors import InvalidMotionError
from solvers.motion import (
    SENSOR_JOINTS,
    Motion,
    Sensor,
    Tracks,
    forward_kinematics,
    joint_parents,
    motion_from_points,
    skeleton_from_points,
)
from solvers.recordings import read_recording
from solvers.rotations.representations import angle_between, quaternion_from_rotation_vector
from solvers.rotations.rotation_fit import fit_rotations

SENSORS = [Sensor.KINECT_V1, Sensor.KINECT_V2, Sensor.AZURE_KINECT]


@pytest.fixture(params=SENSORS, ids=lambda sensor: sensor.value)
def sensor_body(request, rng):
    """A skeleton with the joints of a sensor and bones of 5 to 50 cm in any direction."""
    names = SENSOR_JOINTS[request.param]
    parents = joint_parents(names)
    lengths = rng.uniform(0.05, 0.5, size=(1, len(names), 1))
    directions = rng.normal(size=(1, len(names), 3))
    directions *= lengths / np.linalg.norm(directions, axis=-1, keepdims=True)
    positions = np.zeros_like(directions)
    for joint in sorted(range(len(names)), key=lambda one: depth(one, parents)):
        up = positions[:, parents[joint]] if parents[joint] >= 0 else 0.0
        positions[:, joint] = up + directions[:, joint]
    return skeleton_from_points(Tracks(names, positions, 30.0), parents)


@pytest.fixture
def random_motion(sensor_body, rng):
    rotations = rng.normal(scale=0.8, size=(40, sensor_body.n_joints, 3))
    positions = rng.normal(size=(40, 3))
    return Motion(sensor_body, quaternion_from_rotation_vector(rotations), positions, 30.0)


def depth(joint, parents):
    return 0 if parents[joint] < 0 else 1 + depth(parents[joint], parents)


def points_of(motion):
    return Tracks(motion.skeleton.names, forward_kinematics(motion).positions, 30.0)


def test_joints_are_at_their_observed_positions(sensor_body, random_motion):
    points = points_of(random_motion)

    found = motion_from_points(points, sensor_body.parents, sensor_body)

    assert_allclose(forward_kinematics(found).positions, points.positions, atol=1e-9)


def test_bone_lengths_of_a_rigid_body_are_exact(sensor_body, random_motion):
    found = motion_from_points(points_of(random_motion), sensor_body.parents)

    lengths = dict(zip(found.skeleton.names, found.skeleton.offsets, strict=True))
    for name, offset in list(zip(sensor_body.names, sensor_body.offsets, strict=True))[1:]:
        assert np.linalg.norm(lengths[name]) == pytest.approx(np.linalg.norm(offset))
    assert found.skeleton.rest_positions[:, 2].min() == pytest.approx(0.0)
    order = [sensor_body.names.index(name) for name in found.skeleton.names]
    expected = points_of(random_motion).positions[:, order]
    assert_allclose(forward_kinematics(found).positions, expected, atol=1e-6)


def test_rotations_have_no_twist(sensor_body, random_motion):
    found = motion_from_points(points_of(random_motion), sensor_body.parents, sensor_body)

    for joint, children in enumerate(sensor_body.children):
        if len(children) == 1:
            axis = sensor_body.offsets[children[0]]
            assert_allclose(found.rotations[:, joint, 1:] @ axis, 0.0, atol=1e-9)
        if not children:
            assert_allclose(
                found.rotations[:, joint], np.tile((1, 0, 0, 0), (40, 1)), atol=1e-9
            )


def test_rotating_the_recording_rotates_only_the_root(sensor_body, random_motion):
    points = points_of(random_motion)
    rotation = Rotation.from_euler("z", 50, degrees=True)
    rotated = points.with_positions(points.positions @ rotation.as_matrix().T + (1.0, 2.0, 3.0))

    found, moved = (
        motion_from_points(each, sensor_body.parents, sensor_body) for each in (points, rotated)
    )

    assert angle_between(moved.rotations, found.rotations)[:, 1:].max() < 1e-6
    assert_allclose(moved.root_positions - (1, 2, 3), rotation.apply(found.root_positions))


@pytest.mark.parametrize(
    ("missing_joint", "expected"),
    [
        ("ElbowLeft", {"ShoulderLeft", "ElbowLeft", "WristLeft"}),
        ("HandLeft", {"WristLeft", "HandLeft"}),
        ("FootRight", {"AnkleRight"}),
    ],
)
def test_missing_joint_affects_only_its_bones(missing_joint, expected):
    names = SENSOR_JOINTS[Sensor.KINECT_V2]
    parents = joint_parents(names)
    rng = np.random.default_rng(1)
    points = Tracks(names, rng.normal(size=(20, 25, 3)), 30.0)
    complete = motion_from_points(points, parents)
    missing = np.array(points.positions)
    missing[5:9, names.index(missing_joint)] = np.nan

    found = motion_from_points(points.with_positions(missing), parents, complete.skeleton)

    unknown = {
        found.skeleton.names[joint] for joint in np.flatnonzero(~found.observed.all(axis=0))
    }
    assert unknown == expected
    assert not found.observed[5:9, [found.skeleton.index(name) for name in expected]].any()
    assert_allclose(
        found.rotations[found.observed], complete.rotations[found.observed], atol=1e-12
    )


def test_bone_length_is_the_median(sensor_body, random_motion):
    points = points_of(random_motion)
    joint = points.names.index("Head")
    parent = sensor_body.parents[joint]
    stretched = np.array(points.positions)
    stretched[:19, joint] += 3.0 * (stretched[:19, joint] - stretched[:19, parent])

    found = skeleton_from_points(points.with_positions(stretched), sensor_body.parents)

    length = np.linalg.norm(found.offsets[found.index("Head")])
    assert length == pytest.approx(np.linalg.norm(sensor_body.offsets[joint]))


def test_coincident_joints_define_no_direction():
    points = np.tile([[0.0, 0, 1.0], [0.0, 0, 1.3], [0.0, 0, 1.5]], (4, 1, 1))
    points[2, 1] = points[2, 0]

    found = motion_from_points(Tracks(("a", "b", "c"), points, 30.0), (-1, 0, 1))

    assert found.observed[:, 0].tolist() == [True, True, False, True]


def test_rest_pose_is_a_t_pose_with_measured_lengths(recordings):
    path = recordings / "kinect" / "irds" / "216_18_2_5_2_stand.txt"
    recording = read_recording(path)

    rest = skeleton_from_points(recording.tracks, recording.parents)

    index = dict(zip(rest.names, rest.rest_positions, strict=True))
    assert index["HandLeft"][0] > 0.5 > -0.5 > index["HandRight"][0]
    assert index["HandLeft"][2] == pytest.approx(index["ShoulderLeft"][2], abs=0.02)
    assert index["Head"][2] > 1.3
    assert index["FootLeft"][1] < index["AnkleLeft"][1] - 0.05
    assert index["KneeLeft"][2] == pytest.approx(0.25 * index["Head"][2], rel=0.4)


@pytest.mark.parametrize(
    ("file", "near"),
    [
        ("irds/216_18_2_5_2_stand.txt", 0.015),
        ("laban/Ges03_drawlines.csv", 0.015),
        ("msr_action3d/a02_s02_e02_skeleton3D.txt", 0.03),
        ("ui_prmd/m01_s01_e08.npz", 0.02),
        ("azure/joints_sync_1.csv", 0.01),
    ],
)
def test_real_joints_are_followed_except_for_length_changes(recordings, file, near):
    recording = read_recording(recordings / "kinect" / file)

    motion = motion_from_points(recording.tracks, recording.parents)

    order = [recording.names.index(name) for name in motion.skeleton.names]
    misses = forward_kinematics(motion).positions - recording.tracks.positions[:, order]
    assert np.nanmedian(np.linalg.norm(misses, axis=-1)) < near
    observed = recording.tracks.visible.all(axis=1)
    assert motion.observed[observed].all()


def test_joint_never_observed_has_no_bone(sensor_body, random_motion):
    points = points_of(random_motion)
    missing = np.array(points.positions)
    missing[:, points.names.index("HandLeft")] = np.nan

    found = motion_from_points(points.with_positions(missing), sensor_body.parents)

    gone = set(points.names) - set(found.skeleton.names)
    assert "HandLeft" in gone
    assert gone <= {"HandLeft", "HandTipLeft"}


def test_children_of_a_joint_never_observed_get_its_parent(sensor_body, random_motion):
    points = points_of(random_motion)
    missing = np.array(points.positions)
    root = sensor_body.parents.index(-1)
    middle = next(
        joint for joint, parent in enumerate(sensor_body.parents)
        if parent == root and len(sensor_body.children[joint]) == 1
        and len(sensor_body.children[sensor_body.children[joint][0]])
    )  # fmt: skip
    complete = motion_from_points(points, sensor_body.parents)
    missing[:, middle] = np.nan

    found = motion_from_points(points.with_positions(missing), sensor_body.parents)

    assert set(complete.skeleton.names) - set(found.skeleton.names) == {points.names[middle]}


@pytest.mark.parametrize(
    ("parents", "message"),
    [
        ((-1, -1, 0), "have no parent: a, b"),
        ((1, 2, 0), "have no parent: none"),
        ((-1, 2, 1), "never observed together"),
    ],
)
def test_motion_from_points_raises_for_invalid_trees(parents, message):
    points = Tracks(("a", "b", "c"), np.ones((4, 3, 3)), 30.0)

    with pytest.raises(InvalidMotionError, match=message):
        motion_from_points(points, parents)


def test_motion_from_points_raises_for_another_skeleton(sensor_body):
    points = Tracks(("a", "b"), np.arange(12.0).reshape(2, 2, 3), 30.0)

    with pytest.raises(InvalidMotionError, match="were not tracked"):
        motion_from_points(points, (-1, 0), sensor_body)


def test_fitted_rotations_equal_scipy(rng):
    shape = rng.normal(size=(4, 3))
    observed = rng.normal(size=(30, 4, 3))

    found = fit_rotations(shape, observed)

    for frame, rotation in enumerate(found):
        expected, _ = Rotation.align_vectors(observed[frame], shape)
        between = Rotation.from_quat(rotation[[1, 2, 3, 0]]).inv() * expected
        assert between.magnitude() < 1e-6


def test_one_direction_defines_no_rotation(rng):
    observed = rng.normal(size=(3, 2, 3))
    observed[0, 0] = np.nan
    observed[1, 1] = 2.0 * observed[1, 0]

    found = fit_rotations(np.array([[1.0, 0, 0], [0, 1.0, 0]]), observed)

    assert np.isnan(found).all(axis=1).tolist() == [True, True, False]
