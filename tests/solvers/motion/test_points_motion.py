"""A skeleton follows tracked joints: forward kinematics is the judge."""

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
from solvers.rotations.rigid_fit import fit_rotations

SENSORS = [Sensor.KINECT_V1, Sensor.KINECT_V2, Sensor.AZURE_KINECT]


@pytest.fixture(params=SENSORS, ids=lambda sensor: sensor.value)
def body(request, rng):
    """A skeleton with the joints of a sensor and bones of 5 to 50 cm in any direction."""
    names = SENSOR_JOINTS[request.param]
    parents = joint_parents(names)
    lengths = rng.uniform(0.05, 0.5, size=(1, len(names), 1))
    ways = rng.normal(size=(1, len(names), 3))
    ways *= lengths / np.linalg.norm(ways, axis=-1, keepdims=True)
    places = np.zeros_like(ways)
    for joint in sorted(range(len(names)), key=lambda one: depth(one, parents)):
        up = places[:, parents[joint]] if parents[joint] >= 0 else 0.0
        places[:, joint] = up + ways[:, joint]
    return skeleton_from_points(Tracks(names, places, 30.0), parents)


@pytest.fixture
def dance(body, rng):
    turns = rng.normal(scale=0.8, size=(40, body.n_joints, 3))
    places = rng.normal(size=(40, 3))
    return Motion(body, quaternion_from_rotation_vector(turns), places, 30.0)


def depth(joint, parents):
    return 0 if parents[joint] < 0 else 1 + depth(parents[joint], parents)


def points_of(motion):
    return Tracks(motion.skeleton.names, forward_kinematics(motion).positions, 30.0)


def test_joints_are_where_they_were_seen(body, dance):
    points = points_of(dance)

    found = motion_from_points(points, body.parents, body)

    assert_allclose(forward_kinematics(found).positions, points.positions, atol=1e-9)


def test_a_rigid_body_of_any_pose_tells_its_bone_lengths(body, dance):
    found = motion_from_points(points_of(dance), body.parents)

    lengths = dict(zip(found.skeleton.names, found.skeleton.offsets, strict=True))
    for name, offset in list(zip(body.names, body.offsets, strict=True))[1:]:
        assert np.linalg.norm(lengths[name]) == pytest.approx(np.linalg.norm(offset))
    assert found.skeleton.rest_positions[:, 2].min() == pytest.approx(0.0)
    order = [body.names.index(name) for name in found.skeleton.names]
    expected = points_of(dance).positions[:, order]
    assert_allclose(forward_kinematics(found).positions, expected, atol=1e-6)


def test_nothing_is_said_about_twist(body, dance):
    found = motion_from_points(points_of(dance), body.parents, body)

    for joint, children in enumerate(body.children):
        if len(children) == 1:
            axis = body.offsets[children[0]]
            assert_allclose(found.rotations[:, joint, 1:] @ axis, 0.0, atol=1e-9)
        if not children:
            assert_allclose(
                found.rotations[:, joint], np.tile((1, 0, 0, 0), (40, 1)), atol=1e-9
            )


def test_turning_the_recording_turns_the_root_alone(body, dance):
    points = points_of(dance)
    turn = Rotation.from_euler("z", 50, degrees=True)
    turned = points.with_positions(points.positions @ turn.as_matrix().T + (1.0, 2.0, 3.0))

    found, moved = (motion_from_points(each, body.parents, body) for each in (points, turned))

    assert angle_between(moved.rotations, found.rotations)[:, 1:].max() < 1e-6
    assert_allclose(moved.root_positions - (1, 2, 3), turn.apply(found.root_positions))


@pytest.mark.parametrize(
    ("lost_joint", "expected"),
    [
        ("ElbowLeft", {"ShoulderLeft", "ElbowLeft", "WristLeft"}),
        ("HandLeft", {"WristLeft", "HandLeft"}),
        ("FootRight", {"AnkleRight"}),
    ],
)
def test_a_lost_joint_leaves_its_bones_unknown_and_the_rest_as_it_was(lost_joint, expected):
    names = SENSOR_JOINTS[Sensor.KINECT_V2]
    parents = joint_parents(names)
    rng = np.random.default_rng(1)
    points = Tracks(names, rng.normal(size=(20, 25, 3)), 30.0)
    whole = motion_from_points(points, parents)
    lost = np.array(points.positions)
    lost[5:9, names.index(lost_joint)] = np.nan

    found = motion_from_points(points.with_positions(lost), parents, whole.skeleton)

    unknown = {
        found.skeleton.names[joint] for joint in np.flatnonzero(~found.observed.all(axis=0))
    }
    assert unknown == expected
    assert not found.observed[5:9, [found.skeleton.index(name) for name in expected]].any()
    assert_allclose(
        found.rotations[found.observed], whole.rotations[found.observed], atol=1e-12
    )


def test_a_bone_is_as_long_as_the_median(body, dance):
    points = points_of(dance)
    joint = points.names.index("Head")
    parent = body.parents[joint]
    stretched = np.array(points.positions)
    stretched[:19, joint] += 3.0 * (stretched[:19, joint] - stretched[:19, parent])

    found = skeleton_from_points(points.with_positions(stretched), body.parents)

    length = np.linalg.norm(found.offsets[found.index("Head")])
    assert length == pytest.approx(np.linalg.norm(body.offsets[joint]))


def test_joints_in_the_same_place_tell_no_direction():
    points = np.tile([[0.0, 0, 1.0], [0.0, 0, 1.3], [0.0, 0, 1.5]], (4, 1, 1))
    points[2, 1] = points[2, 0]

    found = motion_from_points(Tracks(("a", "b", "c"), points, 30.0), (-1, 0, 1))

    assert found.observed[:, 0].tolist() == [True, True, False, True]


def test_the_rest_pose_is_a_t_pose_of_the_measured_lengths(recordings):
    path = recordings / "kinect" / "irds" / "216_18_2_5_2_stand.txt"
    recording = read_recording(path)

    rest = skeleton_from_points(recording.tracks, recording.parents)

    place = dict(zip(rest.names, rest.rest_positions, strict=True))
    assert place["HandLeft"][0] > 0.5 > -0.5 > place["HandRight"][0]
    assert place["HandLeft"][2] == pytest.approx(place["ShoulderLeft"][2], abs=0.02)
    assert place["Head"][2] > 1.3
    assert place["FootLeft"][1] < place["AnkleLeft"][1] - 0.05
    assert place["KneeLeft"][2] == pytest.approx(0.25 * place["Head"][2], rel=0.4)


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
def test_real_joints_are_followed_but_for_their_changing_bones(recordings, file, near):
    recording = read_recording(recordings / "kinect" / file)

    motion = motion_from_points(recording.tracks, recording.parents)

    order = [recording.names.index(name) for name in motion.skeleton.names]
    misses = forward_kinematics(motion).positions - recording.tracks.positions[:, order]
    assert np.nanmedian(np.linalg.norm(misses, axis=-1)) < near
    seen = recording.tracks.visible.all(axis=1)
    assert motion.observed[seen].all()


def test_a_joint_that_is_never_seen_has_no_bone(body, dance):
    points = points_of(dance)
    lost = np.array(points.positions)
    lost[:, points.names.index("HandLeft")] = np.nan

    found = motion_from_points(points.with_positions(lost), body.parents)

    gone = set(points.names) - set(found.skeleton.names)
    assert "HandLeft" in gone
    assert gone <= {"HandLeft", "HandTipLeft"}


def test_what_hangs_on_a_joint_that_is_never_seen_hangs_on_the_one_above(body, dance):
    points = points_of(dance)
    lost = np.array(points.positions)
    root = body.parents.index(-1)
    middle = next(
        joint for joint, parent in enumerate(body.parents)
        if parent == root and len(body.children[joint]) == 1
        and len(body.children[body.children[joint][0]])
    )  # fmt: skip
    whole = motion_from_points(points, body.parents)
    lost[:, middle] = np.nan

    found = motion_from_points(points.with_positions(lost), body.parents)

    assert set(whole.skeleton.names) - set(found.skeleton.names) == {points.names[middle]}


@pytest.mark.parametrize(
    ("parents", "words"),
    [
        ((-1, -1, 0), "have no parent: a, b"),
        ((1, 2, 0), "have no parent: none"),
        ((-1, 2, 1), "never observed together"),
    ],
)
def test_what_is_no_tree_is_refused(parents, words):
    points = Tracks(("a", "b", "c"), np.ones((4, 3, 3)), 30.0)

    with pytest.raises(InvalidMotionError, match=words):
        motion_from_points(points, parents)


def test_a_skeleton_of_other_joints_is_refused(body):
    points = Tracks(("a", "b"), np.arange(12.0).reshape(2, 2, 3), 30.0)

    with pytest.raises(InvalidMotionError, match="were not tracked"):
        motion_from_points(points, (-1, 0), body)


def test_best_turns_are_scipys(rng):
    shape = rng.normal(size=(4, 3))
    seen = rng.normal(size=(30, 4, 3))

    found = fit_rotations(shape, seen)

    for frame, turn in enumerate(found):
        expected, _ = Rotation.align_vectors(seen[frame], shape)
        between = Rotation.from_quat(turn[[1, 2, 3, 0]]).inv() * expected
        assert between.magnitude() < 1e-6


def test_one_direction_tells_no_turn(rng):
    seen = rng.normal(size=(3, 2, 3))
    seen[0, 0] = np.nan
    seen[1, 1] = 2.0 * seen[1, 0]

    found = fit_rotations(np.array([[1.0, 0, 0], [0, 1.0, 0]]), seen)

    assert np.isnan(found).all(axis=1).tolist() == [True, True, False]
