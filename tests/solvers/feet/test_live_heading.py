"""The heading of a held foot: fixed while the sole is flat, free on heel or ball."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import minimize

from solvers.denoising.quality.foot_slide import measure_foot_slide, sole_paths
from solvers.feet import LivePlanting, find_legs
from solvers.feet.live_planting import PATCH_RADIUS_M, _LiveFoot
from solvers.motion import Motion, find_humanoid_map, forward_kinematics
from solvers.rotations import inverse, multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait

RATE, N_CALIBRATION, N_FRAMES = 30.0, 60, 180


def standing_with(rotation_vectors):
    """Return a standing actor whose left foot is rotated in the world (n_frames, 3)."""
    walk = walking_gait(GaitSettings(duration=1.0, frame_rate=RATE))
    skeleton = walk.skeleton
    rotations = np.zeros((len(rotation_vectors), skeleton.n_joints, 4))
    rotations[..., 0] = 1.0
    height = -skeleton.rest_positions[:, 2].min()
    root = np.tile([0.0, 0.0, height + skeleton.rest_positions[0, 2]], (len(rotations), 1))
    motion = Motion(skeleton, rotations, root, RATE)
    ankle = find_legs(skeleton)[0].ankle
    foot = forward_kinematics(motion).rotations[:, ankle]
    turn = quaternion_from_rotation_vector(rotation_vectors)
    rotations[:, ankle] = multiply(
        rotations[:, ankle], multiply(inverse(foot), multiply(turn, foot))
    )
    return Motion(skeleton, rotations, root, RATE)


def held(motion):
    live = LivePlanting(motion.slice(0, N_CALIBRATION), find_humanoid_map(motion.skeleton))
    poses = [
        live.update(motion.slice(frame, frame + 1), motion.dt)
        for frame in range(N_CALIBRATION, motion.n_frames)
    ]
    rotations = np.concatenate([pose.motion.rotations for pose in poses])
    root = np.concatenate([pose.motion.root_positions for pose in poses])
    result = Motion(motion.skeleton, rotations, root, RATE)
    return result, np.array([pose.contacts for pose in poses])


def left_sole(motion):
    return sole_paths(motion, forward_kinematics(motion))[0]


def heading(motion):
    points = left_sole(motion).points
    x, y, _ = (points[:, 2] - points[:, 0]).T
    return np.unwrap(np.arctan2(y, x))


def test_a_flat_foot_that_is_captured_back_and_forth_does_not_slide():
    """As a Kinect shows it: by two degrees about the ankle, from frame to frame."""
    noise = np.radians(2.0) * np.random.default_rng(1).normal(size=N_FRAMES)
    motion = standing_with(noise[:, None] * (0.0, 0.0, 1.0))

    found, contacts = held(motion)

    raw = motion.slice(N_CALIBRATION, N_FRAMES)
    assert contacts[:, 0].all()
    steps = [np.diff(left_sole(each).points[..., :2], axis=0) for each in (raw, found)]
    before, after = (np.linalg.norm(each, axis=-1).mean(axis=0) for each in steps)
    assert before[2] > 0.004  # the ball
    assert after.max() < 0.15 * before[2]
    slides = measure_foot_slide(left_sole(found), contacts[:, 0], RATE).distance
    assert slides < 0.05


def test_a_foot_on_its_ball_pivots():
    """The heel is up by 30 degrees, and the foot rotates by 60 in the second half."""
    motion = standing_with(np.zeros((N_FRAMES, 3)))
    angle = np.radians(60.0) * np.clip((np.arange(N_FRAMES) - 120) / 60.0, 0.0, 1.0)
    rise = np.radians(30.0) * np.clip((np.arange(N_FRAMES) - 80) / 20.0, 0.0, 1.0)
    turn = quaternion_from_rotation_vector(angle[:, None] * (0.0, 0.0, 1.0))
    pitch = quaternion_from_rotation_vector(rise[:, None] * (1.0, 0.0, 0.0))
    motion = rolled_about_the_ball(motion, multiply(turn, pitch))

    found, contacts = held(motion)

    raw = motion.slice(N_CALIBRATION, N_FRAMES)
    pivoting = slice(65, None)
    assert contacts[pivoting, 0].mean() > 0.9
    turned = np.ptp(heading(found)[pivoting]) / np.ptp(heading(raw)[pivoting])
    assert turned > 0.7


def rolled_about_the_ball(motion, turn):
    """Return the actor rotated with the foot, so that the left ball stays in place."""
    leg = find_legs(motion.skeleton)[0]
    ball = left_sole(motion).points[:, 2]
    rotations = motion.rotations.copy()
    rotations[:, 0] = multiply(turn, rotations[:, 0])
    rolled = Motion(motion.skeleton, rotations, motion.root_positions, RATE)
    assert leg.side == "left"
    shift = ball - left_sole(rolled).points[:, 2]
    return Motion(motion.skeleton, rotations, motion.root_positions + shift, RATE)


@pytest.mark.parametrize("load", [(0.5, 0.5, 0.0, 0.0), (0.97, 0.01, 0.01, 0.01)])
def test_held_change_is_the_least_squares_one(rng, load):
    """A numerical search over shift and heading, with the patch as a pull to the last one."""
    motion = standing_with(np.zeros((N_CALIBRATION, 3)))
    leg = find_legs(motion.skeleton)[0]
    contact = np.ones(N_CALIBRATION, dtype=bool)
    foot = _LiveFoot(motion, forward_kinematics(motion), leg, contact, 0.0)
    foot._change = np.array([0.01, -0.02, 0.0, 0.2])
    points = rng.normal(size=(4, 3)) * 0.1
    last = points + rng.normal(size=(4, 3)) * 0.02
    weights, size = np.array(load), leg.length(motion.skeleton) / 0.9

    found = foot._hold(points, last, weights)

    def cost(change):
        sine, cosine = np.sin(change[3]), np.cos(change[3])
        turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        moved = (points - points[-1]) @ turn.T + points[-1] + change[:3]
        patch = 2.0 * (PATCH_RADIUS_M * size) ** 2 * (1.0 - np.cos(change[3] - 0.2))
        return weights @ ((moved - last) ** 2).sum(axis=1) + patch

    expected = minimize(cost, [0.0, 0.0, 0.0, 0.2], tol=1e-14).x
    assert_allclose(found, expected, atol=1e-4)


def test_heading_returns_after_the_foot_is_let_go():
    noise = np.zeros(N_FRAMES)
    noise[N_CALIBRATION + 20 : N_CALIBRATION + 60] = np.radians(10.0)
    motion = standing_with(noise[:, None] * (0.0, 0.0, 1.0))
    rise = np.zeros(N_FRAMES)
    rise[N_CALIBRATION + 40 :] = 0.3
    path = motion.root_positions + rise[:, None] * (0.0, 0.0, 1.0)
    lifted = motion.with_poses(motion.rotations, path)

    found, contacts = held(lifted)

    raw = heading(lifted.slice(N_CALIBRATION, N_FRAMES))
    difference = np.abs(heading(found) - raw)
    assert not contacts[45:60, 0].any()
    assert difference[30] > np.radians(8.0)
    assert difference[59] < np.radians(2.0) and np.diff(difference[44:59]).max() <= 1e-9
