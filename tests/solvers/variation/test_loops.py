"""Loops keep their pose and velocity at the seam."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.signal import find_peaks

from solvers.feet import PlantSettings
from solvers.motion import forward_kinematics
from solvers.recordings import read_bvh
from solvers.rotations.representations import (
    multiply,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
)
from solvers.samples import GaitSettings, walking_gait
from solvers.variation import (
    VarySettings,
    borrow_variation,
    draw_variants,
    learn_variation_model,
)
from solvers.variation.align_examples import positions_in_body_frame
from solvers.variation.curves.motion_curves import (
    MotionCurves,
    curves_from_motion,
    headings_from_motion,
    motion_from_curves,
)
from solvers.variation.loops import (
    close_loop,
    detect_loop,
    extract_middle_cycle,
    repeat_loop,
    resample_loop,
)

CMU_METERS = 0.0254 / 0.45
FREE = np.ones(2)


def measure_seam(motion):
    """Return the pose gap at the seam, and its velocity step relative to the clip's largest."""
    rounds, n = repeat_loop(motion, 2), motion.n_frames
    positions = forward_kinematics(rounds).positions
    gap = np.abs(positions[n - 1] - forward_kinematics(motion).positions[-1]).max()
    steps = np.linalg.norm(np.diff(positions, n=2, axis=0), axis=-1).mean(axis=-1)
    return gap, steps[n - 2] / np.delete(steps, n - 2).max()


@pytest.fixture(scope="module")
def cycles(recordings):
    """Return closed cycles of CMU walks, from one extreme of the left foot to the next."""
    found = []
    for path in sorted((recordings / "mocap" / "cmu_walk").glob("35_*.bvh"))[:4]:
        motion = read_bvh(path, scale=CMU_METERS)
        motion = motion.slice(1, motion.n_frames)
        names, body = motion.skeleton.names, positions_in_body_frame(motion)
        distance = body[:, names.index("RightFoot"), 1] - body[:, names.index("LeftFoot"), 1]
        peaks, _ = find_peaks(distance, distance=round(0.8 * motion.frame_rate), height=0.2)
        cycle = motion.slice(int(peaks[0]), int(peaks[1]) + 1)
        assert measure_seam(cycle)[0] > 0.02
        headings, reference_rotations = (
            headings_from_motion(cycle),
            cycle.rotations[0] * 0.0 + (1.0, 0.0, 0.0, 0.0),
        )
        curves = curves_from_motion(cycle, headings, reference_rotations)
        closed = close_loop(curves, cycle.frame_rate, np.ones(len(names)), FREE)
        start = np.append(cycle.root_positions[0, :2], headings[0])
        found.append(
            motion_from_curves(
                closed, cycle.skeleton, reference_rotations, cycle.frame_rate, start
            )
        )
    return found


def test_close_loop_closes_a_cut_cycle(cycles):
    for cycle in cycles:
        gap, step = measure_seam(cycle)
        assert gap < 1e-6
        assert step < 1.0


@pytest.mark.parametrize("planted", [False, True])
@pytest.mark.parametrize("separate", [False, True])
def test_variants_of_a_looping_walk_loop(separate, planted, cycles):
    model = borrow_variation(cycles[0]) if separate else learn_variation_model(cycles)
    assert model.loops

    planting = PlantSettings() if planted else None
    for variant in draw_variants(model, 4, planting=planting):
        assert variant.loops
        gap, step = measure_seam(variant.motion)
        assert gap < 2e-3
        assert step < 1.0


def test_variants_loop_at_the_rate_of_the_scene(cycles):
    variant = draw_variants(learn_variation_model(cycles), 1)[0].motion

    slow = resample_loop(variant, 24.0)

    gap, step = measure_seam(slow)
    assert gap < 1e-3
    assert step < 1.0
    assert slow.frame_rate == 24.0
    assert abs((slow.n_frames - 1) / 24.0 - (variant.n_frames - 1) / 120.0) < 0.5 / 24.0
    assert_allclose(slow.root_positions[0], variant.root_positions[0], atol=5e-3)


def test_loop_stays_open_when_both_ends_are_pinned(cycles):
    model = learn_variation_model(cycles)
    shifted = replace(
        model, joints=model.joints + 0.1 * np.eye(1, model.n_samples)[0, :, None, None]
    )

    pinned = draw_variants(shifted, 1, settings=VarySettings(pin_start=True, pin_end=True))[0]
    free = draw_variants(shifted, 1, settings=VarySettings(pin_start=True))[0]

    assert not pinned.loops
    assert free.loops


def test_detect_loop_rejects_half_a_cycle(walks):
    half = walks[0].slice(0, walks[0].n_frames // 2)
    assert not detect_loop(half, headings_from_motion(half))
    assert detect_loop(walks[0], headings_from_motion(walks[0]))
    assert not any(one.loops for one in draw_variants(learn_variation_model([half]), 1))


def test_detect_loop_rejects_a_swing_that_comes_back_the_other_way(walks):
    """All limbs swing out and back: the first pose again, at the opposite velocity."""
    angles = 0.6 * np.sin(np.pi * np.linspace(0.0, 1.0, 40))
    swing = quaternion_from_rotation_vector(angles[:, None, None] * [1.0, 0.0, 0.0])
    rotations = np.repeat(walks[0].rotations[:1], 40, axis=0)
    rotations[:, 1:] = multiply(rotations[:, 1:], swing)
    roots = np.repeat(walks[0].root_positions[:1], 40, axis=0)
    motion = walks[0].with_poses(rotations, roots)

    assert not detect_loop(motion, headings_from_motion(motion))


def test_close_loop_splits_the_gap_of_a_ramp():
    """A ramp from 0 to 1: each end takes half of the gap; the slopes agree already."""
    rise = np.linspace(0.0, 1.0, 21)
    joints = np.zeros((21, 2, 3))
    joints[:, 0, 0] = joints[:, 1, 0] = rise
    curves = MotionCurves(np.zeros((21, 4)), joints)

    closed = close_loop(curves, 10.0, np.array([1.0, 0.0]), FREE).joints
    late = close_loop(curves, 10.0, np.ones(2), np.array([0.0, 1.0])).joints

    assert_allclose(closed[[0, -1], 0, 0], 0.5)
    assert_allclose(closed[:, 1], joints[:, 1])
    assert_allclose(closed[3:-3, 0], joints[3:-3, 0])
    assert_allclose(late[:-3], joints[:-3])
    assert_allclose(late[-1], 0.0, atol=1e-12)


def test_close_loop_matches_slopes():
    frames = np.arange(41.0)
    joints = np.zeros((41, 1, 3))
    joints[:, 0, 0] = (frames / 20.0 - 1.0) ** 2  # ends as high as it begins, but rising
    closed = close_loop(MotionCurves(np.zeros((41, 4)), joints), 40.0, np.ones(1), FREE).joints
    slopes = np.diff(closed[:, 0, 0])
    assert abs(slopes[0] - slopes[-1]) < 0.25 * abs(2 * (joints[1, 0, 0] - joints[0, 0, 0]))


def test_close_loop_matches_root_speeds():
    root = np.zeros((31, 4))
    root[1:, 1] = np.linspace(0.01, 0.03, 30)
    closed = close_loop(MotionCurves(root, np.zeros((31, 1, 3))), 30.0, np.ones(1), FREE).root
    extrapolated = 1.5 * closed[[1, -1], 1] - 0.5 * closed[[2, -2], 1]
    assert abs(np.diff(extrapolated)[0]) < 0.25 * 0.02


def test_repeated_cycles_start_where_the_previous_ended():
    """Four cycles of a walk through a right angle each return to the start."""
    walk = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
    angle = np.linspace(0.0, np.pi / 2, walk.n_frames)
    about = np.stack([np.cos(angle / 2), 0 * angle, 0 * angle, np.sin(angle / 2)], axis=-1)
    rotations = walk.rotations.copy()
    rotations[:, 0] = multiply(about, walk.rotations[:1, 0])
    positions = np.stack([np.sin(angle), 1 - np.cos(angle), 0 * angle + 0.9], axis=-1)
    quarter = walk.with_poses(rotations, positions)

    circle = repeat_loop(quarter, 4)

    assert circle.n_frames == 4 * (walk.n_frames - 1) + 1
    assert_allclose(circle.root_positions[-1], positions[0], atol=1e-9)
    assert np.linalg.norm(np.diff(circle.root_positions, axis=0), axis=-1).max() < 0.06
    back = rotation_vector_from_quaternion(
        multiply(circle.rotations[-1, 0], quarter.rotations[0, 0] * (1, -1, -1, -1))
    )
    assert_allclose(np.linalg.norm(back) % (2 * np.pi), 0.0, atol=1e-9)


def test_middle_cycle_equals_the_cycle(walks):
    again = extract_middle_cycle(repeat_loop(walks[1], 3), walks[1])
    assert_allclose(again.root_positions[:-1], walks[1].root_positions[:-1], atol=1e-9)
    similarity = np.abs(np.sum(again.rotations * walks[1].rotations, axis=-1))[:-1]
    assert_allclose(similarity, 1.0, atol=1e-9)
