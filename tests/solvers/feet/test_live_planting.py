"""Feet are held frame by frame, from what was seen so far, and let go without a jump."""

import pickle

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.feet import LivePlanting, find_legs
from solvers.feet.live_contacts import LiveContacts
from solvers.motion import (
    Motion,
    Skeleton,
    detect_contacts,
    find_humanoid_map,
    forward_kinematics,
)
from solvers.motion.humanoid import CONTACT_MODEL, foot_points
from solvers.samples import GaitSettings, walking_gait

RATE, N_CALIBRATION = 30.0, 60


@pytest.fixture(scope="module")
def sliding():
    """Eight seconds of a walk on a path that drifts as that of a camera does."""
    walk = walking_gait(GaitSettings(duration=8.0, frame_rate=RATE))
    noise = np.random.default_rng(3).normal(size=(walk.n_frames, 3))
    drift = np.cumsum(0.006 * noise, axis=0) * (1.0, 1.0, 0.2)
    return walk.with_poses(walk.rotations, walk.root_positions + drift)


def held(motion, n_calibration=N_CALIBRATION):
    roles = find_humanoid_map(motion.skeleton)
    live = LivePlanting(motion.slice(0, n_calibration), roles)
    frames = range(n_calibration, motion.n_frames)
    poses = [live.update(motion.slice(frame, frame + 1), motion.dt) for frame in frames]
    result = Motion(
        motion.skeleton,
        np.concatenate([pose.motion.rotations for pose in poses]),
        np.concatenate([pose.motion.root_positions for pose in poses]),
        motion.frame_rate,
    )
    return result, np.array([pose.contacts for pose in poses])


@pytest.fixture(scope="module")
def planted(sliding):
    return held(sliding)


def feet_of(motion):
    return forward_kinematics(motion).positions[:, foot_points(*described(motion))]


def described(motion):
    return motion.skeleton, find_humanoid_map(motion.skeleton)


def slide(motion, contacts):
    """Meters that the slower of ankle and toes covers in contact."""
    steps = np.linalg.norm(np.diff(feet_of(motion)[..., :2], axis=0), axis=-1).min(axis=-1)
    return float(steps[contacts[1:] & contacts[:-1]].sum())


def test_a_held_sole_hardly_slides(sliding, planted):
    motion, contacts = planted
    raw = sliding.slice(N_CALIBRATION, sliding.n_frames)
    later = detect_contacts(sliding)[N_CALIBRATION:]
    assert (contacts == later).mean() > 0.85
    assert slide(motion, contacts) < 0.1 * slide(raw, contacts)
    assert slide(motion, later) < 0.3 * slide(raw, later)


def test_only_legs_rotate(sliding, planted):
    raw = sliding.slice(N_CALIBRATION, sliding.n_frames)
    legs = {joint for leg in find_legs(raw.skeleton) for joint in leg.chain}
    others = [joint for joint in range(raw.n_joints) if joint not in legs]
    assert_array_equal(planted[0].root_positions, raw.root_positions)
    assert_array_equal(planted[0].rotations[:, others], raw.rotations[:, others])


def test_a_foot_returns_to_its_path_without_a_jump(sliding, planted):
    motion, contacts = planted
    raw = sliding.slice(N_CALIBRATION, sliding.n_frames)
    shift = (feet_of(motion) - feet_of(raw))[:, :, 0]
    released = contacts[:-1] & ~contacts[1:]
    before = shift[:-1][released]
    assert released.sum() >= 8
    assert np.linalg.norm(before, axis=-1).max() > 0.03  # something is to be eased out
    change = np.linalg.norm(np.diff(shift, 2, axis=0), axis=-1)[released[:-1]]
    assert change.max() < 0.5 * np.linalg.norm(before, axis=-1).max()


@pytest.mark.parametrize("scale", [1.0, 0.25])
def test_a_foot_that_slides_fast_is_not_held_whatever_the_contact(sliding, scale, monkeypatch):
    """Speeds relative to the leg: 0.5 m/s is too fast for an adult."""
    monkeypatch.setattr(LiveContacts, "update", lambda *_: np.ones(2))
    small = scaled(sliding, scale)

    _, contacts = held(small)

    steps = np.diff(feet_of(small)[N_CALIBRATION - 1 :], axis=0) / scale
    speeds = RATE * np.linalg.norm(steps, axis=-1).min(axis=-1)
    assert speeds.max() > 2.0 and np.quantile(speeds[contacts], 0.97) < 0.7
    assert contacts[speeds < 0.2].mean() > 0.8


def test_a_released_foot_returns_as_a_critically_damped_spring(sliding, monkeypatch):
    """So (a + b t) exp(-16 t): times exp(16 t), it is a straight line."""
    contact = iter([1.0] * (N_CALIBRATION + 5) + [0.0] * 15)
    monkeypatch.setattr(LiveContacts, "update", lambda *_: np.full(2, next(contact)))
    walk = sliding.slice(0, N_CALIBRATION + 20)

    motion, contacts = held(walk)

    shift = (feet_of(motion) - feet_of(walk)[N_CALIBRATION:])[5:, :, 0]
    line = shift * np.exp(16.0 * np.arange(len(shift)) / RATE)[:, None, None]
    assert contacts[:5].any() and not contacts[5:].any()
    assert np.abs(shift[0]).max() > 0.002
    assert_allclose(np.diff(line, 2, axis=0), 0.0, atol=0.01 * np.abs(line).max())


def scaled(motion, factor):
    skeleton = motion.skeleton
    small = Skeleton(skeleton.names, skeleton.parents, factor * skeleton.offsets)
    return Motion(small, motion.rotations, factor * motion.root_positions, motion.frame_rate)


def test_contacts_equal_those_of_complete_arrays(sliding):
    """An independent evaluation: lines by polyfit, and a forward filter over arrays."""
    points = stepping(feet_of(sliding), 40, 80, 0.6)
    noise, size = 0.01, 1.1
    live = LiveContacts(RATE, size, noise)
    found = [live.update(each, 1.0 / RATE) for each in points]

    line = next(n for n in (2, 3, 4) if n == 4 or line_noise(n, noise / size) <= 0.15)
    expected = probabilities(points / size, line, line_noise(line, noise / size))
    assert_allclose(found, expected, atol=1e-9)


def stepping(points, first, last, depth):
    """Return the points, lower by a depth from one frame to another."""
    lowered = points.copy()
    lowered[first:last, ..., 2] -= depth
    return lowered


@pytest.mark.parametrize(
    ("first", "last", "depth", "settled"), [(60, 61, 1.2, 75), (60, 120, 0.6, 212)]
)
def test_contacts_return_after_a_low_frame_and_a_step_down(
    sliding, first, last, depth, settled
):
    """A frame hardly counts; from a low floor the ground has risen after three seconds."""
    points = feet_of(sliding)
    lowered = stepping(points, first, last, depth)
    live, expected = LiveContacts(RATE), LiveContacts(RATE)
    found = [live.update(each, 1.0 / RATE) > 0.5 for each in lowered]
    plain = [expected.update(each, 1.0 / RATE) > 0.5 for each in points]
    assert np.any(plain[settled:], axis=0).all()
    assert_array_equal(found[settled:], plain[settled:])


def test_contacts_after_a_restart_are_those_of_a_new_stream(sliding):
    points = feet_of(sliding)
    live, new = LiveContacts(RATE, noise=0.01), LiveContacts(RATE, noise=0.01)
    for each in points[:60]:
        live.update(each - (0.0, 0.0, 1.0), 1.0 / RATE)
    live.restart()
    found = [live.update(each, 1.0 / RATE) for each in points[60:90]]
    assert_array_equal(found, [new.update(each, 1.0 / RATE) for each in points[60:90]])


def line_noise(n, noise):
    return noise * RATE * np.sqrt(12.0 / (n * (n**2 - 1)))


def probabilities(points, line, speed_noise):
    speeds, heights = np.zeros(points.shape[:-1]), np.zeros(points.shape[:-1])
    lower, levels, grounds = [], [], []
    for frame in range(len(points)):
        part = points[max(frame - line + 1, 0) : frame + 1]
        mean = part.mean(axis=0)
        lower.append(mean[..., 2].min(axis=0))
        levels.append(np.min(lower[max(frame - 30, 0) :], axis=0))
        grounds.append(np.max(levels[max(frame - 60, 0) :], axis=0))
        top = np.minimum(grounds[-1], np.min(grounds[max(frame - 60, 0) :], axis=0) + 0.3)
        heights[frame] = mean[..., 2] - top
        if len(part) > 1:
            slopes = np.polyfit(np.arange(len(part)) / RATE, part.reshape(len(part), -1), 1)[0]
            squares = (slopes.reshape(2, 2, 3) ** 2).sum(axis=-1)
            speeds[frame] = np.sqrt(np.maximum(squares - 3.0 * speed_noise**2, 0.0))
    model, dt = CONTACT_MODEL, 1.0 / RATE
    odds = (
        model.bias
        - model.speed_weight * np.log1p((speeds / model.speed) ** 2)
        - model.height_weight * np.log1p((np.maximum(heights, 0.0) / model.height) ** 2)
    ).max(axis=-1)
    likelihood = np.exp(odds * dt / (model.memory + (line - 1) * dt))
    total = model.landing_rate + model.lift_rate
    changed = 1.0 - np.exp(-total * dt)
    second, result = np.full(2, model.landing_rate / total), []
    for frame, ratio in enumerate(likelihood):
        if frame:
            second = second + changed * (model.landing_rate / total - second)
        second = second * ratio / (second * ratio + 1.0 - second)
        result.append(second)
    return np.array(result)


def test_memory_does_not_grow(sliding):
    roles = find_humanoid_map(sliding.skeleton)
    live = LivePlanting(sliding.slice(0, N_CALIBRATION), roles)
    sizes = []
    for frame in range(N_CALIBRATION, N_CALIBRATION + 120):
        live.update(sliding.slice(frame, frame + 1), sliding.dt)
        sizes.append(len(pickle.dumps(live)))
    assert max(sizes[:60]) == max(sizes)


def test_a_foot_that_is_held_too_far_away_slides_on(sliding):
    """The floor moves by a meter under a standing actor: no leg is pulled along."""
    standing = sliding.slice(0, 1)
    n_frames = 180
    path = np.zeros((n_frames, 3))
    path[N_CALIBRATION:, 0] = 0.1 * np.arange(n_frames - N_CALIBRATION) / RATE
    moved = Motion(
        standing.skeleton,
        np.repeat(standing.rotations, n_frames, axis=0),
        standing.root_positions + path,
        RATE,
    )
    motion, _ = held(moved)
    raw = moved.slice(N_CALIBRATION, n_frames)
    distance = np.linalg.norm(feet_of(motion) - feet_of(raw), axis=-1)
    assert 0.1 < distance.max() < 0.2


@pytest.mark.parametrize("is_other_actor", [False, True])
def test_after_a_gap_and_with_another_actor_feet_begin_again(sliding, is_other_actor):
    """The first pose stays as it is, and the floor may be another one."""
    roles = find_humanoid_map(sliding.skeleton)
    live = LivePlanting(sliding.slice(0, N_CALIBRATION), roles)
    for frame in range(N_CALIBRATION, 90):
        pose = sliding.slice(frame, frame + 1)
        shifted = live.update(pose, sliding.dt).motion
    assert np.abs(feet_of(shifted) - feet_of(pose)).max() > 0.005
    later = sliding.slice(150, 180)
    later = later.with_poses(later.rotations, later.root_positions + np.array([0.0, 0.0, 1.0]))
    pose, elapsed_s = later.slice(0, 1), 2.0
    if is_other_actor:
        live.restart()
        elapsed_s = sliding.dt
    assert_array_equal(live.update(pose, elapsed_s).motion.rotations, pose.rotations)
    found = [live.update(later.slice(n, n + 1), sliding.dt).contacts for n in range(1, 30)]
    assert np.any(found, axis=0).all()
