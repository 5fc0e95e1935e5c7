"""Channels lose nothing and are invariant to position, heading and rig."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising.channels.encode import decode, encode
from solvers.denoising.channels.travel_path import (
    fit_local_lines,
    fit_travel_path,
    rotate_on_ground,
)
from solvers.motion import Motion, Skeleton, Tracks, forward_kinematics
from solvers.rotations.representations import (
    angle_between,
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))


@pytest.fixture
def tracks(walk) -> Tracks:
    positions = forward_kinematics(walk).positions
    return Tracks(walk.skeleton.names, positions, walk.frame_rate)


def test_motion_is_decoded_exactly(walk):
    channels = encode(walk)

    back = decode(walk, channels, channels.values)

    assert angle_between(back.rotations, walk.rotations).max() < 1e-7
    assert_allclose(back.root_positions, walk.root_positions, atol=1e-12)


def test_parents_of_parts_are_those_of_the_skeleton(walk):
    """End sites have no part, and the root position has no parent."""
    channels, skeleton = encode(walk), walk.skeleton

    assert channels.parents is not None
    pairs = zip(channels.joints[:-1], channels.parents[:-1], strict=True)
    parents = [channels.joints[part] if part >= 0 else -1 for _, part in pairs]
    assert parents == [skeleton.parents[joint] for joint in channels.joints[:-1]]
    assert channels.parents[-1] == -1


def test_joint_with_a_mean_half_a_turn_away_does_not_flip(walk):
    """Actors may have feet with other rest poses: the sign of a rotation must not jump."""
    references = dict(encode(walk).references)
    key = "leftUpperLeg"
    opposite = multiply(references[key][:4], quaternion_from_rotation_vector([np.pi, 0.0, 0.0]))
    references[key] = np.concatenate([opposite, references[key][4:]])

    channels = encode(walk, references)

    part = channels.keys.index(key)
    step = np.abs(np.diff(encode(walk).values[:, part], axis=0)).max()
    assert np.abs(np.diff(channels.values[:, part], axis=0)).max() < 3.0 * step
    back = decode(walk, channels, channels.values)
    assert angle_between(back.rotations, walk.rotations).max() < 1e-7


def test_tracks_are_decoded_exactly(tracks):
    channels = encode(tracks)

    back = decode(tracks, channels, channels.values)

    assert_allclose(back.positions, tracks.positions, atol=1e-12)


def test_channels_are_invariant_to_position_and_heading(walk, tracks):
    angle, shift = 2.0, np.array([3.0, -1.0, 0.0])
    rotation = quaternion_from_rotation_vector([0.0, 0.0, angle])
    rotations = walk.rotations.copy()
    rotations[:, 0] = multiply(rotation, rotations[:, 0])
    moved = walk.with_poses(rotations, rotate(rotation, walk.root_positions) + shift)
    moved_tracks = tracks.with_positions(rotate(rotation, tracks.positions) + shift)

    assert_allclose(encode(moved).flat, encode(walk).flat, atol=1e-5)
    assert_allclose(encode(moved_tracks).flat, encode(tracks).flat, atol=1e-5)


def test_channels_are_invariant_to_the_rest_pose(walk):
    """Arms with a lowered rest pose need less rotation to hang: the movement is the same."""
    other = with_lowered_arms(walk)
    of_walk = encode(walk)

    of_other = encode(other, of_walk.references)

    assert set(of_other.keys) == set(of_walk.keys)
    for key in ("leftUpperArm", "leftLowerArm", "rightUpperLeg", "head", "hips"):
        expected = of_walk.values[:, of_walk.keys.index(key)]
        actual = of_other.values[:, of_other.keys.index(key)]
        assert_allclose(actual, expected, atol=0.5)
    back = decode(other, of_other, of_other.values)
    assert angle_between(back.rotations, other.rotations).max() < 1e-7


def test_missing_samples_stay_missing_and_change_no_others(walk):
    rotations = walk.rotations.copy()
    rotations[10:20, 3] = np.nan

    gapped = encode(walk.with_poses(rotations), encode(walk).references)

    missing = np.isnan(gapped.values).any(axis=2)
    assert missing.sum() == 10
    complete = encode(walk).values
    assert_allclose(gapped.values[~missing], complete[~missing], atol=1e-9)


def test_path_of_a_straight_walk_is_straight_across_a_gap():
    """A gap of six seconds, wider than the kernel of the path."""
    ground_positions = np.stack([np.zeros(360), -np.arange(360) / 30.0], axis=-1)
    observed = ground_positions.copy()
    observed[90:270] = np.nan

    path = fit_travel_path(observed, np.full(360, 0.4), 30.0)

    assert_allclose(path.ground_positions, ground_positions, atol=1e-9)
    assert_allclose(path.headings, 0.4, atol=1e-9)


def test_local_lines_of_a_line_are_the_line(rng):
    line = np.outer(np.arange(50.0), [1.0, -2.0]) + 3.0

    assert_allclose(fit_local_lines(line, 4.0), line, atol=1e-9)
    assert_allclose(rotate_on_ground(rotate_on_ground(line, 0.7), -0.7), line, atol=1e-9)


def with_lowered_arms(walk: Motion) -> Motion:
    """Return the same walk on a body whose rest pose has the upper arms 40 degrees lower."""
    skeleton = walk.skeleton
    rest = np.tile([1.0, 0.0, 0.0, 0.0], (skeleton.n_joints, 1))
    for name, angle in (("LeftArm", 0.7), ("RightArm", -0.7)):
        lowered = quaternion_from_rotation_vector([0.0, angle, 0.0])
        for joint in skeleton.subtree(skeleton.index(name)):
            rest[joint] = lowered
    parents = list(skeleton.parents)
    above = np.concatenate([[[1.0, 0, 0, 0]], rest[parents[1:]]])
    offsets = rotate(above, skeleton.offsets)
    other = Skeleton(skeleton.names, skeleton.parents, offsets)
    rotations = multiply(multiply(above, walk.rotations), inverse(rest))
    return Motion(other, rotations, walk.root_positions, walk.frame_rate)
