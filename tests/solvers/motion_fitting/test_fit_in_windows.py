"""Long takes are fitted in windows that pass into each other."""

from importlib import import_module
from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising import plant_feet
from solvers.motion import detect_contacts
from solvers.motion_fitting.fit_in_windows import join_windows, window_ranges
from solvers.samples import GaitSettings, walking_gait

MODULE = import_module("solvers.motion_fitting.fit_in_windows")
"""The package's name of the same spelling is the function."""


@pytest.mark.parametrize("n_frames", [1, 100, 3999, 4000, 4001, 7940, 7941, 100_000])
def test_windows_cover_a_take_and_overlap(n_frames):
    ranges = window_ranges(n_frames, 30.0)

    assert ranges[0][0] == 0 and ranges[-1][1] == n_frames
    assert all(stop - start <= 4000 for start, stop in ranges)
    for (_, stop), (start, _) in pairwise(ranges):
        assert stop - start == 60


def test_equal_windows_join_to_the_take(monkeypatch):
    monkeypatch.setattr(MODULE, "MAX_FRAMES", 100)
    walk = walking_gait(GaitSettings(duration=12.0, frame_rate=30.0))
    ranges = window_ranges(walk.n_frames, walk.frame_rate)

    joined = join_windows([walk.slice(*each) for each in ranges], ranges)

    assert len(ranges) > 5
    assert_allclose(joined.rotations, walk.rotations, atol=1e-12)
    assert_allclose(joined.root_positions, walk.root_positions, atol=1e-12)


def test_planted_in_windows_as_at_once(monkeypatch):
    walk = walking_gait(GaitSettings(duration=12.0, frame_rate=30.0))
    roots = walk.root_positions.copy()
    roots[:, :2] += 0.1 * (roots[:, :2] - roots[0, :2])
    skating, contacts = walk.with_poses(root_positions=roots), detect_contacts(walk)
    at_once = plant_feet(skating, contacts)

    monkeypatch.setattr(MODULE, "MAX_FRAMES", 150)
    in_windows = plant_feet(skating, contacts)

    assert in_windows.slide_after < 0.02 * in_windows.slide_before
    moved = in_windows.motion.root_positions - at_once.motion.root_positions
    assert np.abs(moved).max() < 0.005
