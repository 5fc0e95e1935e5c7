"""Terms of reliability, compared with manual results of [SHJT13], eq. 3 to 8."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import norm

from solvers.errors import InvalidSettingError
from solvers.motion import JointRecording, Sensor, Tracks
from solvers.reconstruction import ReliabilityMethod, ReliabilitySettings, measure_reliability
from solvers.reconstruction.reliability.error_model import CAUSAL_MODEL as AS_IT_COMES
from solvers.reconstruction.reliability.error_model import CENTERED_MODEL
from solvers.reconstruction.reliability.terms import (
    behavior_term,
    gaussian_mean,
    kinematics_term,
    tracking_term,
)

CAUSAL = ReliabilitySettings(causal=True)
PUBLISHED = ReliabilitySettings(method=ReliabilityMethod.PUBLISHED)


def path_with_corners(*angles: float, length: float = 0.1) -> np.ndarray:
    """One joint that moves in a plane by steps of equal length and rotates by these degrees."""
    directions = np.radians(np.cumsum([0.0, *angles]))
    moves = length * np.stack(
        [np.cos(directions), np.sin(directions), 0.0 * directions], axis=-1
    )
    return np.concatenate([np.zeros((1, 3)), np.cumsum(moves, axis=0)])[:, None]


@pytest.mark.parametrize(
    ("angles", "expected"),
    [
        ((90.0, 90.0, 90.0), 1.0),
        ((120.0, 120.0, 120.0), 1.0 / 3.0),  # 1 - (120 - 90) / (135 - 90)
        ((180.0, 90.0, 90.0), 1.0 / 3.0),  # the same mean
        ((135.0, 135.0, 135.0), 0.0),
        ((180.0, 180.0, 180.0), 0.0),  # back and forth
        ((180.0, 0.0, 0.0), 1.0),  # a single spike is ignored
    ],
)
def test_behavior_term_depends_on_the_mean_turn(angles, expected):
    term = behavior_term(path_with_corners(*angles), 30.0, CAUSAL)

    assert term[-1, 0] == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize(("length", "expected"), [(0.0299, 1.0), (0.0301, 0.0)])
def test_steps_below_three_centimeters_are_not_vibration(length, expected):
    path = path_with_corners(180.0, 180.0, 180.0, length=length)

    assert behavior_term(path, 30.0, CAUSAL)[-1, 0] == pytest.approx(expected, abs=1e-6)


def test_settings_raise_for_a_roof_below_the_floor():
    with pytest.raises(InvalidSettingError, match="it must lie above min_vibration_angle, 90"):
        ReliabilitySettings(max_vibration_angle=80.0)


def test_the_floor_is_a_speed_at_any_frame_rate():
    corners = path_with_corners(*[180.0] * 9, length=0.0299)[:, 0, 0]
    path = np.zeros((41, 1, 3))
    path[:, 0, 0] = np.interp(np.arange(41) / 4.0, np.arange(11), corners)

    assert_allclose(behavior_term(path, 120.0, PUBLISHED), 1.0)
    assert behavior_term(3.0 * path, 120.0, PUBLISHED).min() < 0.5


def test_causal_vibration_uses_past_frames_only():
    path = path_with_corners(*[0.0] * 9, *[180.0] * 10)
    changed = path.copy()
    changed[12:] = 5.0

    before = behavior_term(path, 30.0, CAUSAL)
    after = behavior_term(changed, 30.0, CAUSAL)

    assert_allclose(after[:12], before[:12])
    assert before[13, 0] == pytest.approx(0.0)  # frames 10 to 12 reverse
    assert behavior_term(path, 30.0, PUBLISHED)[11, 0] == pytest.approx(0.0)


def test_same_vibration_is_detected_at_any_frame_rate():
    time = np.arange(240) / 120.0
    path = np.zeros((240, 1, 3))
    path[:, 0, 0] = 0.08 * np.sin(2.0 * np.pi * 12.0 * time + 0.3)
    rates = {30.0: 4, 60.0: 2, 120.0: 1}

    means = [
        behavior_term(path[::step], rate, PUBLISHED)[step:-step].mean()
        for rate, step in rates.items()
    ]

    assert max(means) < 0.65
    assert np.ptp(means) < 0.1


def test_kinematics_term_is_the_mean_over_adjacent_segments():
    """A root with two children and one grandchild: segments of 0.5, 0.4 and 0.2 m."""
    parents = np.array([-1, 0, 0, 1])
    reference = np.array([np.nan, 0.5, 0.4, 0.2])
    lengths = np.array([[np.nan, 0.6, 0.4, 0.5]])

    term = kinematics_term(lengths, reference, parents)

    ratios = {1: 0.2, 2: 0.0, 3: 1.0}  # eq. 5: 0.1 / 0.5, nothing, and 0.3 / 0.2 cut off at 1
    assert_allclose(
        term[0],
        [
            1.0 - (ratios[1] + ratios[2]) / 2.0,
            1.0 - (ratios[1] + ratios[3]) / 2.0,
            1.0,
            0.0,
        ],
        atol=1e-12,
    )


def test_missing_segments_are_ignored():
    parents = np.array([-1, 0, 0])
    lengths = np.array([[np.nan, 0.6, np.nan]])

    term = kinematics_term(lengths, np.array([np.nan, 0.5, 0.4]), parents)

    assert_allclose(term[0], [0.8, 0.8, 1.0])


def test_window_is_six_frames_with_most_weight_on_the_last():
    """Eq. 8, computed explicitly for a joint that is missing in one frame."""
    missing = np.ones((20, 1))
    missing[10] = 0.0
    weights = np.exp(-0.5 * (np.arange(6) / 2.0) ** 2)

    mean = gaussian_mean(missing, 30.0, CAUSAL)

    assert_allclose(mean[:10], 1.0)
    assert_allclose(mean[10:16, 0], 1.0 - weights / weights.sum(), atol=1e-12)
    assert_allclose(mean[16:], 1.0)


def test_offline_window_is_centered():
    missing = np.ones((21, 1))
    missing[10] = 0.0

    mean = gaussian_mean(missing, 30.0, PUBLISHED)[:, 0]

    assert_allclose(mean, mean[::-1], atol=1e-12)
    assert mean.argmin() == 10
    assert (mean < 1.0 - 1e-9).sum() == 7


def still(n_frames: int = 40, state: np.ndarray | None = None) -> JointRecording:
    names = ("ShoulderLeft", "ElbowLeft", "WristLeft")
    positions = np.tile([[0.0, 2.0, 1.4], [0.3, 2.0, 1.4], [0.55, 2.0, 1.4]], (n_frames, 1, 1))
    return JointRecording(Tracks(names, positions, 30.0), state, Sensor.KINECT_V2)


@pytest.mark.parametrize(("causal", "model"), [(False, CENTERED_MODEL), (True, AS_IT_COMES)])
def test_default_reliability_is_a_normal_probability(causal, model):
    """All indicators of a still body are 0, and the linear model is at its floor."""
    settings = ReliabilitySettings(causal=causal, tolerance=0.02)

    found = measure_reliability(still(), settings=settings).combined

    line = model.level + model.slope * np.log(model.floor)
    chance = norm.cdf(np.log(0.03), loc=line, scale=model.spread)  # 2 cm and the 1 cm added
    assert_allclose(found, chance, atol=1e-6)
    assert CENTERED_MODEL != AS_IT_COMES


def test_tracking_states_have_their_configured_values():
    state = np.full((40, 3), 2)
    state[:, 1], state[:, 2] = 1, 0

    strict = measure_reliability(still(state=state))
    mild = measure_reliability(still(state=state), settings=ReliabilitySettings(inferred=0.4))

    assert_allclose(strict.tracking, np.tile([1.0, 0.0, 0.0], (40, 1)))
    assert_allclose(mild.tracking, np.tile([1.0, 0.4, 0.0], (40, 1)))
    assert_allclose(mild.combined[:, 1], 0.4)


def test_published_is_the_windowed_minimum_of_the_terms():
    recording = still()
    rng = np.random.default_rng(2)
    positions = recording.tracks.positions + rng.normal(scale=0.06, size=(40, 3, 3))
    state = np.where(rng.random((40, 3)) < 0.2, 1, 2)
    noisy = JointRecording(recording.tracks.with_positions(positions), state, Sensor.KINECT_V2)
    settings = ReliabilitySettings(method=ReliabilityMethod.PUBLISHED, causal=True)

    found = measure_reliability(noisy, settings=settings)

    minimum = np.minimum(np.minimum(found.behavior, found.kinematics), found.tracking)
    weights = np.exp(-0.5 * (np.arange(6) / 2.0) ** 2)
    for frame in (0, 3, 17, 39):
        past = minimum[max(frame - 5, 0) : frame + 1][::-1]
        fraction = weights[: len(past)] / weights[: len(past)].sum()
        assert_allclose(found.combined[frame], fraction @ past, atol=1e-12)
    assert 0.05 < found.combined.mean() < 0.95


@pytest.mark.parametrize("inferred", [0.0, 0.5])
def test_confidence_without_states_maps_from_inferred_to_one(inferred):
    confidence = np.array([[0.0, 0.5, 1.0]])
    tracks = Tracks(("a", "b", "c"), np.zeros((1, 3, 3)), 30.0, confidence)
    settings = ReliabilitySettings(inferred=inferred)
    state = np.array([[2, 1, 0]])

    found = tracking_term(JointRecording(tracks, None, Sensor.OTHER), settings)
    by_state = tracking_term(JointRecording(tracks, state, Sensor.OTHER), settings)

    assert_allclose(found, [[inferred, (1.0 + inferred) / 2.0, 1.0]])
    assert_allclose(by_state, [[1.0, inferred, 0.0]])
