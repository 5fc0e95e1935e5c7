"""Short gaps follow the joint's own path, long gaps the library pose."""

import numpy as np

from solvers.reconstruction.pose_completion.bridge_gaps import HALF_WEIGHT_S, blend_short_gaps

RATE = 100.0


def sine_path(n: int) -> np.ndarray:
    return np.stack([np.sin(np.arange(n) / 40.0 + phase) for phase in range(3)], -1)[:, None]


def gap_mask(n: int, start: int, stop: int) -> np.ndarray:
    certain = np.ones((n, 1), bool)
    certain[start:stop] = False
    return certain


def test_short_gap_follows_its_own_path_whatever_the_library_has():
    true = sine_path(300)
    found = blend_short_gaps(true, gap_mask(300, 100, 104), true + 1.0, RATE)
    assert np.abs(found - true).max() < 0.01


def test_library_pose_dominates_inside_a_long_gap():
    true = sine_path(1000)
    found = blend_short_gaps(true * 0.0, gap_mask(1000, 100, 900), true, RATE)
    assert np.abs(found - true)[450:550].max() < 0.03
    assert np.abs(found - true)[:95].max() > 0.5


def test_path_and_posture_have_equal_weight_at_the_half_weight_time():
    n_missing = int(4 * HALF_WEIGHT_S * RATE)
    observed, rebuilt = np.zeros((n_missing + 200, 1, 3)), np.ones((n_missing + 200, 1, 3))
    found = blend_short_gaps(
        observed, gap_mask(n_missing + 200, 100, 100 + n_missing), rebuilt, RATE
    )
    np.testing.assert_allclose(found[100 + n_missing // 2], 0.5, atol=0.02)


def test_one_sided_gap_is_left_to_the_library():
    true = sine_path(200)
    for certain in (gap_mask(200, 0, 50), gap_mask(200, 150, 200), np.zeros((200, 1), bool)):
        found = blend_short_gaps(
            np.where(certain[..., None], true, np.nan), certain, true + 1.0, RATE
        )
        np.testing.assert_array_equal(found[~certain], (true + 1.0)[~certain])
