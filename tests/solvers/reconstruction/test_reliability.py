"""Reliability of complete bodies is low for wrong joints only."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.motion import SENSOR_JOINTS, JointRecording, Sensor, Tracks
from solvers.motion.humanoid.posture_heading import rotate_about_vertical
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS, postures_from_motion
from solvers.reconstruction import ReliabilityMethod, ReliabilitySettings, measure_reliability
from solvers.reconstruction.reliability.reference import (
    find_reference_postures,
    parent_distances,
    reference_lengths,
)
from solvers.samples import GaitSettings, walking_gait

NAMES = SENSOR_JOINTS[Sensor.KINECT_V1]
ROLES = dict(
    zip(
        POSTURE_JOINTS,
        ("HipCenter", "Spine", "ShoulderCenter", "Head",
         "ShoulderLeft", "ElbowLeft", "WristLeft", "HandLeft",
         "ShoulderRight", "ElbowRight", "WristRight", "HandRight",
         "HipLeft", "KneeLeft", "AnkleLeft", "FootLeft",
         "HipRight", "KneeRight", "AnkleRight", "FootRight"),
        strict=True,
    )
)  # fmt: skip
METHODS = [
    ReliabilitySettings(method=method, causal=causal)
    for method in ReliabilityMethod
    for causal in (False, True)
]


def named(settings: ReliabilitySettings) -> str:
    return f"{settings.method.value}{' causal' if settings.causal else ''}"


every_method = pytest.mark.parametrize("settings", METHODS, ids=named)


def recorded(positions: np.ndarray, frame_rate: float = 30.0) -> JointRecording:
    tracks = Tracks(NAMES, positions, frame_rate)
    return JointRecording(tracks, None, Sensor.KINECT_V1)


def walk_at(frame_rate: float) -> np.ndarray:
    postures = postures_from_motion(
        walking_gait(GaitSettings(duration=3.0, frame_rate=frame_rate))
    )
    order = [list(ROLES.values()).index(name) for name in NAMES]
    return postures[:, order]


@pytest.fixture(scope="module")
def walk() -> np.ndarray:
    return walk_at(30.0)


def joint_index(name: str) -> int:
    return NAMES.index(name)


def vibrating(walk: np.ndarray, name: str, size: float = 0.06) -> np.ndarray:
    """One joint vibrates in the middle of the take."""
    wrong = walk.copy()
    jumps = size * (-1.0) ** np.arange(30)
    wrong[30:60, joint_index(name), 0] += jumps
    return wrong


@every_method
def test_still_body_is_reliable(walk, settings):
    still = np.tile(walk[:1], (60, 1, 1))

    assert measure_reliability(recorded(still), settings=settings).combined.min() > 0.99


def test_clean_walk_is_reliable(walk):
    combined = measure_reliability(recorded(walk)).combined

    assert combined.mean() > 0.98
    assert combined.min() > 0.85  # knees and feet at footfall


@every_method
def test_vibrating_joint_is_unreliable_and_others_hardly(walk, settings):
    before = measure_reliability(recorded(walk), settings=settings).combined
    after = measure_reliability(
        recorded(vibrating(walk, "HandLeft")), settings=settings
    ).combined

    fall = (before - after)[38:58].mean(axis=0)
    hand = joint_index("HandLeft")
    near = [hand, joint_index("WristLeft")]  # they share a segment
    assert fall[hand] > 0.4
    assert np.delete(fall, near).max() < 0.01
    assert fall[joint_index("WristLeft")] < 0.75 * fall[hand]
    assert (before - after)[:15].max() < 0.05


@every_method
def test_leg_with_a_temporary_length_error_is_unreliable(walk, settings):
    wrong = walk.copy()
    knee, ankle, foot = (joint_index(f"{part}Left") for part in ("Knee", "Ankle", "Foot"))
    longer = 0.3 * (walk[20:40, ankle] - walk[20:40, knee])
    wrong[20:40, [ankle, foot]] += longer[:, None]

    before = measure_reliability(recorded(walk), settings=settings)
    after = measure_reliability(recorded(wrong), settings=settings)

    assert_allclose(after.kinematics[25:35, foot], before.kinematics[25:35, foot], atol=1e-9)
    assert_allclose(
        (before.kinematics - after.kinematics)[25:35, ankle], 0.15, atol=0.02
    )  # one of two segments is off by 0.3
    fall = (before.combined - after.combined)[28:38].mean(axis=0)
    assert fall[ankle] > 0.1
    assert fall[knee] > 0.05
    assert fall[joint_index("KneeRight")] < 1e-9


@every_method
def test_posture_ignores_position_and_heading(walk, settings):
    wrong = vibrating(walk, "AnkleRight")
    moved = rotate_about_vertical(wrong, np.full(len(walk), 2.1)) + np.array([3.0, -4.0, 0.5])

    one = measure_reliability(recorded(wrong), settings=settings)
    other = measure_reliability(recorded(moved), settings=settings)

    assert_allclose(one.combined, other.combined, atol=1e-6)


def test_constant_velocity_walk_has_no_deviation(walk):
    """The ends of a path are extrapolated, so speed does not lower reliability there."""
    gone = walk + np.arange(len(walk))[:, None, None] * np.array([0.06, 0.0, 0.0])

    one, other = (measure_reliability(recorded(each)).combined for each in (walk, gone))

    assert_allclose(one, other, atol=1e-6)


@pytest.mark.parametrize("frame_rate", [60.0, 120.0])
def test_reliability_agrees_at_all_frame_rates(frame_rate):
    step = int(frame_rate / 30.0)
    rng = np.random.default_rng(5)
    sway = np.cumsum(rng.normal(size=(91, 20, 3)), axis=0)
    fast = walk_at(frame_rate)
    n_frames = len(fast)
    at = np.arange(n_frames) / step
    wrong = 0.01 * np.stack(
        [np.interp(at, np.arange(91), column) for column in sway.reshape(91, -1).T], axis=-1
    )
    fast = fast + wrong.reshape(fast.shape)

    slow = measure_reliability(recorded(fast[::step])).combined
    fast_reliability = measure_reliability(recorded(fast, frame_rate)).combined[::step]

    assert 0.4 < slow.mean() < 0.98
    assert np.abs(slow - fast_reliability).mean() < 0.06


@every_method
def test_missing_joints_have_no_reliability_and_others_keep_theirs(walk, settings):
    gone = walk.copy()
    gone[20:30, joint_index("HandRight")] = np.nan
    gone[:, joint_index("FootLeft")] = np.nan

    found = measure_reliability(recorded(gone), settings=settings)

    for term in (found.combined, found.behavior, found.kinematics, found.tracking):
        assert np.isfinite(term).all()
        assert ((term >= 0.0) & (term <= 1.0)).all()
        assert (term[20:30, joint_index("HandRight")] == 0.0).all()
        assert (term[:, joint_index("FootLeft")] == 0.0).all()
    assert found.combined[:, joint_index("Head")].min() > 0.9
    assert found.combined[45:, joint_index("HandRight")].min() > 0.7


def test_behavior_has_its_former_name(walk):
    found = measure_reliability(recorded(walk))

    assert found.behaviour is found.behavior


def test_input_stays_unchanged_and_progress_is_reported(walk):
    recording = recorded(vibrating(walk, "HandLeft"))
    before = recording.tracks.positions.copy()
    fractions = []

    measure_reliability(
        recording, progress=lambda fraction, message="": fractions.append(fraction)
    )

    assert_array_equal(recording.tracks.positions, before)
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0


@every_method
@pytest.mark.parametrize("shape", [(1, 1), (1, 20), (2, 20), (5, 1)])
def test_shortest_takes_have_a_reliability(walk, settings, shape):
    positions = walk[: shape[0], : shape[1]]
    tracks = Tracks(NAMES[: shape[1]], positions, 30.0)

    found = measure_reliability(
        JointRecording(tracks, None, Sensor.KINECT_V1), settings=settings
    )

    assert found.combined.shape == shape
    assert (found.combined > 0.9).all()


def test_reference_postures_are_standing_and_t_pose_only():
    limbs = {"down": (0.0, 0.0, -1.0), "out": (1.0, 0.0, 0.0), "ahead": (0.0, -1.0, 0.0)}
    frames = np.stack([body(limbs["down"]), body(limbs["out"]), body(limbs["ahead"])])
    tracked = np.ones(frames.shape[:2], bool)

    assert find_reference_postures(NAMES, frames, tracked).tolist() == [True, True, False]
    tilt = np.radians(35.0)
    rotation = np.array([
        [1, 0, 0],
        [0, np.cos(tilt), -np.sin(tilt)],
        [0, np.sin(tilt), np.cos(tilt)],
    ])
    assert find_reference_postures(NAMES, frames @ rotation.T, tracked).tolist() == [
        True,
        True,
        False,
    ]
    tracked[1, 7] = False
    assert find_reference_postures(NAMES, frames, tracked).tolist() == [True, False, False]


def body(arm: tuple[float, float, float]) -> np.ndarray:
    """All joints of a standing body with its arms in this direction; left is at +X."""
    at = {"HipCenter": (0.0, 0.0, 0.9), "Spine": (0, 0, 1.1), "ShoulderCenter": (0, 0, 1.4),
          "Head": (0, 0, 1.6)}  # fmt: skip
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        shoulder = np.array([0.2 * sign, 0.0, 1.4])
        direction = np.array(arm) * (sign, 1.0, 1.0)
        parts = ("Shoulder", "Elbow", "Wrist", "Hand")
        at |= {f"{p}{side}": shoulder + 0.28 * n * direction for n, p in enumerate(parts)}
        for rise, part in ((0.9, "Hip"), (0.5, "Knee"), (0.1, "Ankle"), (0.02, "Foot")):
            at[f"{part}{side}"] = np.array([0.1 * sign, -0.15 * (part == "Foot"), rise])
    return np.array([at[name] for name in NAMES])


def test_lengths_are_measured_in_reference_postures_if_any():
    lengths = np.full((40, 2), 0.5)
    lengths[10:20] = 0.4
    postures = np.zeros(40, bool)
    reliability = np.ones((40, 2))
    reliability[:, 1] = 0.0
    reliability[10:17, 1] = 1.0

    assert_allclose(reference_lengths(lengths, postures, reliability), [0.5, 0.4])
    postures[10:20] = True
    assert_allclose(reference_lengths(lengths, postures, reliability), [0.4, 0.4])
    postures[14:20] = False  # four are too few
    assert_allclose(reference_lengths(lengths, postures, reliability), [0.5, 0.4])


def test_reference_postures_with_an_inferred_joint_are_ignored():
    frames = np.tile(body((0.0, 0.0, -1.0)), (30, 1, 1))
    frames[:20, joint_index("HandLeft"), 2] -= 0.1
    state = np.full(frames.shape[:2], 2)
    state[:20, joint_index("Head")] = 1
    recording = JointRecording(Tracks(NAMES, frames, 30.0), state, Sensor.KINECT_V1)

    kinematics = measure_reliability(recording).kinematics

    assert_allclose(kinematics[20:], 1.0)
    assert_allclose(kinematics[:20, joint_index("HandLeft")], 1.0 - 0.1 / 0.28)


def test_low_reliability_lasts_equally_long_at_any_frame_rate():
    lasting = []
    for frame_rate in (30.0, 120.0):
        still = np.tile(walk_at(30.0)[:1], (round(4.0 * frame_rate), 1, 1))
        burst = slice(round(2.0 * frame_rate), round(2.3 * frame_rate))
        sign = (-1.0) ** (np.arange(still[burst].shape[0]) * 30.0 // frame_rate)
        still[burst, joint_index("HandLeft"), 1] += 0.05 * sign
        found = measure_reliability(recorded(still, frame_rate)).combined
        lasting.append((found[:, joint_index("HandLeft")] < 0.9).sum() / frame_rate)

    assert 0.5 < lasting[0] < 1.5
    assert lasting[1] == pytest.approx(lasting[0], abs=0.2)


def test_segments_of_roots_have_no_length():
    lengths = parent_distances(np.array([[[0.0, 0, 0], [0, 3.0, 4.0]]]), np.array([-1, 0]))

    assert np.isnan(lengths[0, 0])
    assert lengths[0, 1] == 5.0
