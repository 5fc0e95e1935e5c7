"""Motions and tracks are valid: shapes, units, gaps and copies."""

import pickle

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.errors import InvalidMotionError
from solvers.motion import Motion, Tracks


def test_rotations_are_normalized(swinging_leg):
    near = swinging_leg.with_poses(1.0004 * swinging_leg.rotations)

    assert_allclose(np.linalg.norm(near.rotations, axis=-1), 1.0, atol=1e-15)


def test_motion_names_joints_with_invalid_rotations(swinging_leg):
    rotations = swinging_leg.rotations.copy()
    rotations[5, 1] *= 2.0
    rotations[9, 2] = 0.0

    with pytest.raises(InvalidMotionError, match="these are not: knee, ankle"):
        swinging_leg.with_poses(rotations)


def test_motion_names_joints_with_invalid_rotations_in_any_frame(leg):
    rotations = np.zeros((5000, 4, 4))
    rotations[..., 0] = 1.0
    rotations[10, 2] = 0.0
    rotations[4500, 1] = 0.0

    with pytest.raises(InvalidMotionError, match="these are not: knee, ankle"):
        Motion(leg, rotations, np.zeros((5000, 3)), 30.0)


def test_rotation_with_a_missing_component_is_missing(swinging_leg):
    rotations = swinging_leg.rotations.copy()
    rotations[5, 1, 2] = np.nan

    gapped = swinging_leg.with_poses(rotations)

    assert np.isnan(gapped.rotations[5, 1]).all()
    assert not gapped.observed[5, 1]
    assert gapped.observed.sum() == gapped.observed.size - 1


def test_root_without_a_position_is_not_observed(swinging_leg):
    root_positions = swinging_leg.root_positions.copy()
    root_positions[3, 1] = np.nan

    observed = swinging_leg.with_poses(root_positions=root_positions).observed

    assert not observed[3, 0]
    assert observed[3, 1:].all()


def test_slice_holds_the_requested_frames(swinging_leg):
    cut = swinging_leg.slice(10, 25)

    assert (cut.n_frames, cut.n_joints, cut.frame_rate) == (15, 4, 60.0)
    assert_allclose(cut.rotations, swinging_leg.rotations[10:25])
    assert_allclose(cut.root_positions, swinging_leg.root_positions[10:25])
    assert cut.dt == 1.0 / 60.0


def test_motion_copies_its_arrays(swinging_leg):
    root_positions = swinging_leg.root_positions.copy()
    motion = swinging_leg.with_poses(root_positions=root_positions)
    root_positions[:] = 9.0

    assert_allclose(motion.root_positions, swinging_leg.root_positions)


def test_motion_can_be_pickled(swinging_leg):
    copied = pickle.loads(pickle.dumps(swinging_leg))

    assert_allclose(copied.rotations, swinging_leg.rotations, atol=0)


@pytest.mark.parametrize(("rotations", "positions", "rate", "sentence"), [
    ((0, 4, 4), (0, 3), 30.0, "at least one frame"),
    ((2, 3, 4), (2, 3), 30.0, r"shape \(n_frames, 4, 4\), not \(2, 3, 4\)"),
    ((2, 4, 4), (3, 3), 30.0, r"of shape \(2, 3\), not \(3, 3\)"),
    ((2, 4, 4), (2, 3), 0.0, "frame rate of 0 Hz is not that of a recording"),
    ((2, 4, 4), (2, 3), np.nan, "frame rate of nan Hz is not that of a recording"),
    ((2, 4, 4), (2, 3), 3.3e9, "between 0.01 and 10,000 Hz"),
])  # fmt: skip
def test_motion_raises_for_invalid_arrays(leg, rotations, positions, rate, sentence):
    values = np.zeros(rotations)
    values[..., 0] = 1.0
    with pytest.raises(InvalidMotionError, match=sentence):
        Motion(leg, values, np.zeros(positions), rate)


def test_motion_raises_for_an_infinite_root(swinging_leg):
    root_positions = swinging_leg.root_positions.copy()
    root_positions[0, 0] = np.inf

    with pytest.raises(InvalidMotionError, match="infinite positions"):
        swinging_leg.with_poses(root_positions=root_positions)


@pytest.fixture
def tracks() -> Tracks:
    positions = np.arange(30.0).reshape(5, 2, 3)
    positions[2, 1, 0] = np.nan
    return Tracks(("wrist", "elbow"), positions, 50.0, np.full((5, 2), 0.5))


def test_point_is_visible_where_all_coordinates_are_finite(tracks):
    expected = np.ones((5, 2), dtype=bool)
    expected[2, 1] = False

    assert_array_equal(tracks.visible, expected)
    assert (tracks.n_frames, tracks.n_points, tracks.dt) == (5, 2, 0.02)


def test_confidence_follows_the_frames(tracks):
    assert tracks.slice(1, 3).confidence.shape == (2, 2)
    assert tracks.with_positions(tracks.positions + 1).confidence is not None


@pytest.mark.parametrize(("names", "shape", "rate", "confidence", "sentence"), [
    (("a",), (0, 1, 3), 30.0, None, "at least one frame"),
    ((), (4, 0, 3), 30.0, None, "at least one frame and one point"),
    (("a",), (4, 2, 3), 30.0, None, r"shape \(n_frames, 1, 3\), not \(4, 2, 3\)"),
    (("a", "a"), (4, 2, 3), 30.0, None, "duplicates: a"),
    (("a",), (4, 1, 3), -1.0, None, "frame rate of -1 Hz"),
    (("a",), (4, 1, 3), 30.0, np.ones((3, 1)), r"shape \(4, 1\), not \(3, 1\)"),
    (("a",), (4, 1, 3), 30.0, np.full((4, 1), 1.5), "between 0 and 1"),
    (("a",), (4, 1, 3), 30.0, np.full((4, 1), np.nan), "between 0 and 1"),
])  # fmt: skip
def test_tracks_raise_for_invalid_arrays(names, shape, rate, confidence, sentence):
    with pytest.raises(InvalidMotionError, match=sentence):
        Tracks(names, np.zeros(shape), rate, confidence)
