"""A second camera is found by the skeletons: independent sums, laws, and hopeless takes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.depth_tracking.several_cameras import AlignmentSettings, align_tracks
from solvers.depth_tracking.several_cameras.lagged_fits import fit_all_lags
from solvers.errors import InvalidMotionError
from solvers.motion import Tracks
from solvers.rotations import nearest_rotations

NAMES = tuple(f"joint {number}" for number in range(8))
SHAPE = np.random.default_rng(3).normal(scale=0.4, size=(len(NAMES), 3))


def rotation(*vector: float) -> np.ndarray:
    angle = np.linalg.norm(vector)
    x, y, z = np.asarray(vector) / angle
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


CAMERA = np.eye(4)
CAMERA[:3, :3], CAMERA[:3, 3] = rotation(0.2, 1.4, -0.1), (2.0, 0.3, 2.5)
"""camera_from_first of the second camera."""


STILL = np.eye(4)


def moving(times: np.ndarray) -> np.ndarray:
    """Return the joints of an actor who walks a curve and waves, at times in seconds."""
    path = np.stack(
        [np.sin(0.9 * times), 0.05 * np.cos(3.1 * times), 0.4 * times + 0.1 * times**2], axis=1
    )
    phases = np.arange(len(NAMES))
    waves = 0.25 * np.sin(times[:, None] * (2.0 + 0.37 * phases) + phases)
    return path[:, None] + SHAPE + waves[..., None] * np.roll(SHAPE, 1, axis=0)


def seen(times: np.ndarray, rate: float, camera: np.ndarray = STILL, noise: float = 0.0):
    positions = moving(times) @ camera[:3, :3].T + camera[:3, 3]
    rng = np.random.default_rng(5)
    return Tracks(
        NAMES, positions + rng.normal(scale=noise + 1e-12, size=positions.shape), rate
    )


def second(offset: float, rate: float = 30.0, n_frames: int = 100, noise: float = 0.0):
    return seen(offset + np.arange(n_frames) / rate, rate, CAMERA, noise)


FIRST = seen(np.arange(120) / 30.0, 30.0)


def test_sums_of_all_lags_equal_a_fit_at_each_lag(rng):
    """Every lag by itself: slices, weighted means, and one singular value decomposition."""
    first, other = rng.normal(size=(9, 4, 3)), rng.normal(size=(6, 4, 3))
    weights = rng.uniform(size=(9, 4)), rng.uniform(size=(6, 4))

    fits = fit_all_lags((first, weights[0]), (other, weights[1]))

    assert fits.lags.tolist() == list(range(-5, 9))
    for index, lag in enumerate(fits.lags):
        frames = [k for k in range(6) if 0 <= k + lag < 9]
        a, b = first[np.add(frames, lag)], other[frames]
        w = (weights[0][np.add(frames, lag)] * weights[1][frames])[..., None]
        means = [(w * each).sum(axis=(0, 1)) / w.sum() for each in (a, b)]
        turn = nearest_rotations(np.einsum("fji,fjk->ik", w * (a - means[0]), b - means[1]))[0]
        separation = (w * ((a - means[0]) - (b - means[1]) @ turn.T) ** 2).sum() / w.sum()
        still = [
            (w * (each - (w * each).sum(axis=0) / w.sum(axis=0)) ** 2).sum() / w.sum()
            for each in (a, b)
        ]
        assert_allclose(fits.weights[index], w.sum())
        assert_allclose(fits.mismatch[index], separation, atol=1e-9)
        assert_allclose(fits.movement[index], sum(still), atol=1e-9)


@pytest.mark.parametrize(
    ("offset", "rate"), [(0.0, 30.0), (0.5, 30.0), (0.217, 30.0), (-0.713, 25.0), (1.1, 60.0)]
)
def test_place_and_time_of_a_camera_are_found(offset, rate):
    """Also between frames, at other rates, and where the second camera began first."""
    found = align_tracks(FIRST, second(offset, rate))

    assert found.offset == pytest.approx(offset, abs=1e-3)
    assert found.angle_to(CAMERA) < 0.05
    assert_allclose(found.camera_from_first, CAMERA, atol=2e-3)


def test_swapped_cameras_give_the_inverse():
    there, back = align_tracks(FIRST, second(0.3)), align_tracks(second(0.3), FIRST)

    assert_allclose(there.camera_from_first @ back.camera_from_first, np.eye(4), atol=1e-3)
    assert there.offset == pytest.approx(-back.offset, abs=1e-4)


def test_noise_and_a_wrong_limb_hardly_move_the_camera():
    other = second(0.217, noise=0.02)
    wrong = other.positions.copy()
    wrong[20:60, 2] += (0.4, 0.1, -0.3)
    wrong[5:9, 4] = np.nan

    found = align_tracks(FIRST, Tracks(NAMES, wrong, 30.0))

    assert found.offset == pytest.approx(0.217, abs=0.004)
    assert_allclose(found.camera_from_first, CAMERA, atol=0.01)


def test_joints_without_confidence_do_not_count():
    other = second(0.217)
    confidence = np.ones((other.n_frames, len(NAMES)))
    confidence[:, :3] = 0.0
    wrong = other.positions.copy()
    wrong[:, :3] += 5.0

    found = align_tracks(FIRST, Tracks(NAMES, wrong, 30.0, confidence))

    assert_allclose(found.camera_from_first, CAMERA, atol=2e-3)


def test_actor_who_stands_still_aligns_no_camera(rng):
    still = [
        Tracks(NAMES, SHAPE + rng.normal(scale=0.015, size=(90, len(NAMES), 3)), 30.0)
        for _ in range(2)
    ]
    with pytest.raises(InvalidMotionError, match=r"^The actor stands still"):
        align_tracks(*still)


def test_takes_of_other_motions_are_refused():
    later = seen(50.0 + np.arange(100) / 30.0, 30.0, CAMERA)
    backward = Tracks(NAMES, later.positions[::-1].copy(), 30.0)
    with pytest.raises(InvalidMotionError, match=r"do not show the same motion|common"):
        align_tracks(FIRST, backward)


def test_repeated_motion_has_no_unique_offset(rng):
    """Jumping jacks on the spot look the same one jump later."""
    times = np.arange(240) / 30.0
    swing = np.sin(2.0 * np.pi * times)[:, None, None] * np.roll(SHAPE, 1, axis=0)
    in_place = SHAPE + 0.4 * swing
    takes = [
        Tracks(NAMES, in_place[part] + rng.normal(scale=0.01, size=(180, len(NAMES), 3)), 30.0)
        for part in (slice(0, 180), slice(45, 225))
    ]
    with pytest.raises(InvalidMotionError, match=r"^The motion repeats itself"):
        align_tracks(*takes)

    within_a_jump = AlignmentSettings(max_offset=0.4)
    with pytest.raises(InvalidMotionError):
        align_tracks(Tracks(NAMES, SHAPE[None].repeat(60, 0), 30.0), takes[0])
    found = align_tracks(takes[0], Tracks(NAMES, in_place[9:189], 30.0), settings=within_a_jump)
    assert found.offset == pytest.approx(0.3, abs=0.01)


def test_too_short_overlap_and_other_skeletons_are_refused():
    with pytest.raises(InvalidMotionError, match="less than 5 s in common"):
        align_tracks(FIRST, second(0.2), settings=AlignmentSettings(min_overlap=5.0))
    with pytest.raises(InvalidMotionError, match="at least three joints"):
        align_tracks(FIRST, Tracks(("a", "b"), np.zeros((9, 2, 3)), 30.0))
    with pytest.raises(InvalidMotionError, match="without positions"):
        align_tracks(FIRST, Tracks(NAMES, np.full((9, len(NAMES), 3), np.nan), 30.0))


def test_two_strides_of_a_straight_walk_are_enough(rng):
    """One stride later most of it looks the same, but less of it is in common."""

    def walk(times):
        swing = np.sin(2.0 * np.pi * times / 1.1)[:, None, None] * np.roll(SHAPE, 1, axis=0)
        path = np.stack([1.2 * times, 0.0 * times, 0.02 * np.sin(times)], axis=1)
        noise = rng.normal(scale=0.01, size=(len(times), len(NAMES), 3))
        return path[:, None] + SHAPE + 0.3 * swing + noise

    times = np.arange(70) / 30.0
    takes = [Tracks(NAMES, walk(part), 30.0) for part in (times, times[:64] + 0.2)]

    assert align_tracks(*takes).offset == pytest.approx(0.2, abs=0.02)
