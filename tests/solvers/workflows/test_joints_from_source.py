"""What was measured is found again for a motion that was made of it."""

import numpy as np
import pytest
from kinect_walks import tracked_walk, true_positions
from numpy.testing import assert_allclose, assert_array_equal

from solvers import motion as vocabulary
from solvers import samples
from solvers.motion import Motion, Skeleton, motion_from_points
from solvers.motion.humanoid import posture_joints
from solvers.motion.humanoid.missing_hips import fill_missing_hips
from solvers.rotations.representations import multiply, quaternion_from_rotation_vector, rotate
from solvers.workflows.joints_from_source import joints_from_source


@pytest.fixture
def walk():
    truth = true_positions(samples, posture_joints)
    recording = tracked_walk(vocabulary, truth)
    positions = recording.tracks.positions
    positions[10:14, recording.names.index("KneeLeft")] = np.nan
    return recording.with_tracks(recording.tracks.with_positions(positions))


def test_all_joints_are_recovered_below_a_missing_joint(walk):
    motion = motion_from_points(walk.tracks, walk.parents)

    found = joints_from_source(motion, walk)

    order = [walk.names.index(name) for name in found.names]
    assert_allclose(found.tracks.positions, walk.tracks.positions[:, order], atol=1e-9)
    assert_array_equal(found.tracking_state, walk.tracking_state[:, order])
    ankle = found.names.index("AnkleLeft")
    assert found.tracks.visible[10:14, ankle].all()


def test_confidence_of_a_tracker_without_states_is_recovered(walk):
    messages = np.random.default_rng(2).random(walk.tracks.positions.shape[:2])
    tracks = vocabulary.Tracks(walk.names, walk.tracks.positions, 30.0, messages)
    sure = vocabulary.JointRecording(tracks, None, walk.sensor)

    found = joints_from_source(motion_from_points(walk.tracks, walk.parents), sure)

    order = [walk.names.index(name) for name in found.names]
    assert_array_equal(found.tracks.confidence, messages[:, order])


def test_joints_follow_a_moved_armature(walk):
    """Rotated about Z, scaled, and moved, as a moved armature."""
    motion = motion_from_points(walk.tracks, walk.parents)
    rotation, shift = (
        quaternion_from_rotation_vector(np.array([0.0, 0.0, 0.8])),
        (1.0, 2.0, 0.9),
    )
    body = motion.skeleton
    larger = Skeleton(body.names, body.parents, 1.1 * rotate(rotation, body.offsets))
    back = rotation * (1.0, -1.0, -1.0, -1.0)
    rotations = multiply(multiply(rotation, motion.rotations), back)  # about rotated axes
    rotations[:, 0] = multiply(multiply(rotation, motion.rotations[:, 0]), back)
    moved = Motion(
        larger, rotations, 1.1 * rotate(rotation, motion.root_positions) + shift, 30.0
    )

    found = joints_from_source(moved, walk)

    head = walk.tracks.positions[:, walk.names.index("Head")]
    expected = 1.1 * rotate(rotation, head) + shift
    assert_allclose(found.tracks.positions[:, found.names.index("Head")], expected, atol=1e-6)


@pytest.mark.parametrize("change", ["edited", "filled", "other", "slower"])
def test_source_is_ignored_for_an_edited_motion(walk, change):
    motion = motion_from_points(walk.tracks, walk.parents)
    rotations = motion.rotations.copy()
    if change == "edited":
        elbow = motion.skeleton.index("ElbowLeft")
        bend = quaternion_from_rotation_vector(np.array([0.0, 0.0, 0.3]))
        rotations[40, elbow] = multiply(rotations[40, elbow], bend)
    if change == "filled":
        rotations = np.where(np.isnan(rotations), (1.0, 0.0, 0.0, 0.0), rotations)
    motion = motion.with_poses(rotations)
    if change == "slower":
        motion = motion.with_poses(rotations[::2].repeat(2, axis=0))
    if change == "other":
        motion = samples.walking_gait(samples.GaitSettings(duration=3.0, frame_rate=30.0))

    assert joints_from_source(motion, walk) is None


@pytest.mark.parametrize(("first", "stop"), [(0, 40), (5, 60), (70, 90), (30, 31)])
def test_segment_is_found_at_its_frames(walk, first, stop):
    motion = motion_from_points(walk.tracks, walk.parents).slice(first, stop)

    found = joints_from_source(motion, walk)

    order = [walk.names.index(name) for name in found.names]
    assert found.n_frames == stop - first
    assert_allclose(found.tracks.positions, walk.tracks.positions[first:stop, order], atol=1e-9)
    assert_array_equal(found.tracking_state, walk.tracking_state[first:stop, order])


def test_source_is_ignored_for_an_edited_segment(walk):
    motion = motion_from_points(walk.tracks, walk.parents).slice(20, 70)
    indices = motion.root_positions.copy()
    indices[30] += 0.05

    assert joints_from_source(motion.with_poses(motion.rotations, indices), walk) is None


def test_source_is_ignored_for_a_longer_motion(walk):
    motion = motion_from_points(walk.tracks, walk.parents)
    twice = motion.with_poses(
        np.concatenate([motion.rotations] * 2), np.concatenate([motion.root_positions] * 2)
    )

    assert joints_from_source(twice, walk) is None


def test_motionless_take_is_matched(walk):
    still = walk.with_tracks(
        walk.tracks.with_positions(np.repeat(walk.tracks.positions[:1], 90, axis=0))
    )
    motion = motion_from_points(still.tracks, still.parents).slice(50, 80)

    assert joints_from_source(motion, still) is not None


def test_motion_with_estimated_hips_matches_its_source(walk):
    positions = walk.tracks.positions.copy()
    positions[:, walk.names.index("HipCenter")] = np.nan
    untracked = walk.with_tracks(walk.tracks.with_positions(positions))
    complete = fill_missing_hips(untracked)

    found = joints_from_source(motion_from_points(complete.tracks, complete.parents), untracked)

    legs = [found.names.index(name) for name in ("HipLeft", "HipRight")]
    middle = found.tracks.positions[:, legs].mean(axis=1)
    assert_allclose(found.tracks.positions[:, found.names.index("HipCenter")], middle)
    assert np.isnan(untracked.tracks.positions[:, untracked.names.index("HipCenter")]).all()
