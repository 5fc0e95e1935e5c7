"""The takes of bench-video must have the faults that they are named after."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import find_humanoid_map, forward_kinematics
from solvers.recordings import read_recording
from solvers.rotations import angle_between
from solvers.samples import GaitSettings, walking_gait
from tests.benchmarks.video.video_measures import figures_of, foot_joints
from tests.benchmarks.video.video_takes import Faults, damage, on_smpl, write_smpl_x


@pytest.fixture(scope="module")
def walk():
    return on_smpl(walking_gait(GaitSettings(duration=2.0, frame_rate=30.0)))


def test_a_written_take_is_read_back_as_it_was(walk, tmp_path):
    write_smpl_x(walk, tmp_path / "take.npz")

    found = read_recording(tmp_path / "take.npz")

    assert find_humanoid_map(found.skeleton).score == 1.0
    assert np.abs(angle_between(found.rotations, walk.rotations)).max() < 1e-6
    assert_allclose(found.root_positions, walk.root_positions, atol=0.01)


def test_without_faults_nothing_changes(walk, rng):
    damaged = damage(walk, Faults(), rng)

    assert_allclose(damaged.root_positions, walk.root_positions, atol=1e-9)
    assert np.abs(angle_between(damaged.rotations, walk.rotations)).max() < 1e-6


@pytest.mark.parametrize(
    ("faults", "column", "least"),
    [
        (Faults(jitter_deg=2.0), "jitter, m/s³", 500.0),
        (Faults(wobble_deg=3.0), "angle error, °", 3.0),
        (Faults(travel=0.8), "root drift, cm", 5.0),
        (Faults(rise_m=0.1), "floats, cm", 3.0),
    ],
)
def test_each_fault_shows_in_its_figure(walk, rng, faults, column, least):
    contacts = np.ones((walk.n_frames, 2), dtype=bool)

    before = figures_of(walk, contacts, walk)[column]
    after = figures_of(damage(walk, faults, rng), contacts, walk)[column]

    assert after > before + least


def test_swapped_legs_swap_the_feet_for_a_few_frames(walk):
    damaged = damage(walk, Faults(swaps_per_s=3.0), np.random.default_rng(1))

    ankles = foot_joints(walk)[:, 0]
    found, true = (
        forward_kinematics(motion).positions[:, ankles] for motion in (damaged, walk)
    )
    moved = np.linalg.norm(found - true, axis=-1).max(axis=1) > 0.1
    assert 0.02 < moved.mean() < 0.7
