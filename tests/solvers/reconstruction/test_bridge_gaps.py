"""Short gaps and joints at rest follow the joint's own path, long gaps the library pose."""

import numpy as np

from solvers.reconstruction.pose_completion.bridge_gaps import HALF_WEIGHT_S, blend_gaps

RATE = 100.0


def blended(tracked, reliable, rebuilt, error=0.05):
    return blend_gaps(tracked, reliable, rebuilt, np.full(reliable.shape, error), RATE)


def sine_path(n: int) -> np.ndarray:
    return np.stack([np.sin(np.arange(n) / 40.0 + phase) for phase in range(3)], -1)[:, None]


def gap_mask(n: int, start: int, stop: int) -> np.ndarray:
    certain = np.ones((n, 1), bool)
    certain[start:stop] = False
    return certain


def test_short_gap_follows_its_own_path_whatever_the_library_has():
    true = sine_path(300)
    found = blended(true, gap_mask(300, 100, 104), true + 1.0)
    assert np.abs(found - true).max() < 0.01


def test_library_pose_dominates_inside_a_long_gap():
    true = sine_path(1000)
    found = blended(true * 0.0, gap_mask(1000, 100, 900), true)
    assert np.abs(found - true)[450:550].max() < 0.03
    assert np.abs(found - true)[:95].max() > 0.5


def test_path_and_posture_have_equal_weight_at_the_half_weight_time():
    n_missing = int(4 * HALF_WEIGHT_S * RATE)
    observed, rebuilt = np.zeros((n_missing + 200, 1, 3)), np.ones((n_missing + 200, 1, 3))
    found = blended(observed, gap_mask(n_missing + 200, 100, 100 + n_missing), rebuilt)
    np.testing.assert_allclose(found[100 + n_missing // 2], 0.5, atol=0.02)


def test_one_sided_gap_is_left_to_the_library():
    true = sine_path(200)
    for certain in (gap_mask(200, 0, 50), gap_mask(200, 150, 200), np.zeros((200, 1), bool)):
        found = blended(np.where(certain[..., None], true, np.nan), certain, true + 1.0)
        np.testing.assert_array_equal(found[~certain], (true + 1.0)[~certain])


def standing_and_stepping(n: int, n_steps: int = 3) -> np.ndarray:
    """A foot that stands, and now and then is lifted by 30 cm for 60 frames."""
    path = np.zeros((n, 1, 3))
    for start in np.linspace(100, n - 200, n_steps).astype(int):
        path[start : start + 60, 0, 2] = 0.3 * np.sin(np.linspace(0.0, np.pi, 60))
    return path


def test_resting_joint_stays_where_it_was_though_the_library_errs():
    true = standing_and_stepping(2000)
    certain = gap_mask(2000, 400, 500)

    found = blended(true, certain, true + 0.06)

    assert np.abs(found - true)[400:500].max() < 0.02


def test_movement_between_equal_ends_is_left_to_the_library():
    """The foot was lifted while it was lost; only the library pose shows it."""
    true = standing_and_stepping(2000)
    start = int(np.flatnonzero(true[:, 0, 2])[0])

    found = blended(true, gap_mask(2000, start - 10, start + 70), true + 0.02)

    lifted = slice(start + 20, start + 40)
    assert true[lifted, 0, 2].min() > 0.25
    assert np.abs(found - true)[lifted].max() < 0.12


def test_a_joint_that_never_rests_elsewhere_is_left_to_the_library():
    """Its ends are as far apart as those of the windows that are hidden."""
    swinging = 0.1 * sine_path(2000)
    still = gap_mask(2000, 900, 1100)

    found = blended(swinging, still, swinging + 0.03, error=0.03)

    assert np.abs(found - swinging)[980:1020].max() < 0.06
