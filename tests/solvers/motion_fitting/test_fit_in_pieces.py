"""Long takes are fitted in pieces that pass into each other."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising import plant_feet
from solvers.motion import detect_contacts
from solvers.motion_fitting import pieces
from solvers.motion_fitting.fit_in_pieces import join_pieces, piece_ranges
from solvers.samples import GaitSettings, walking_gait


@pytest.mark.parametrize("n_frames", [1, 100, 3999, 4000, 4001, 7940, 7941, 100_000])
def test_pieces_cover_a_take_and_overlap(n_frames):
    ranges = piece_ranges(n_frames, 30.0)

    assert ranges[0][0] == 0 and ranges[-1][1] == n_frames
    assert all(stop - start <= 4000 for start, stop in ranges)
    for (_, stop), (start, _) in pairwise(ranges):
        assert stop - start == 60


def test_equal_pieces_join_to_the_take(monkeypatch):
    monkeypatch.setattr(pieces, "MAX_FRAMES", 100)
    walk = walking_gait(GaitSettings(duration=12.0, frame_rate=30.0))
    ranges = piece_ranges(walk.n_frames, walk.frame_rate)

    joined = join_pieces([walk.slice(*each) for each in ranges], ranges)

    assert len(ranges) > 5
    assert_allclose(joined.rotations, walk.rotations, atol=1e-12)
    assert_allclose(joined.root_positions, walk.root_positions, atol=1e-12)


def test_planted_in_pieces_as_at_once(monkeypatch):
    walk = walking_gait(GaitSettings(duration=12.0, frame_rate=30.0))
    roots = walk.root_positions.copy()
    roots[:, :2] += 0.1 * (roots[:, :2] - roots[0, :2])
    skating, contacts = walk.with_poses(root_positions=roots), detect_contacts(walk)
    at_once = plant_feet(skating, contacts)

    monkeypatch.setattr(pieces, "MAX_FRAMES", 150)
    in_pieces = plant_feet(skating, contacts)

    assert in_pieces.slide_after < 0.02 * in_pieces.slide_before
    moved = in_pieces.motion.root_positions - at_once.motion.root_positions
    assert np.abs(moved).max() < 0.005
