"""Spikes of Check are errors for Clean's outlier model: not fast movement, but bursts too."""

import numpy as np
import pytest

from solvers.denoising.quality.confirm_spikes import confirm_spikes
from solvers.denoising.quality.joint_signals import SpikeRule, extract_signals
from solvers.denoising.quality.measure import QualitySettings, measure_quality
from solvers.motion import Motion
from solvers.recordings import read_recording
from solvers.rotations.representations import multiply, quaternion_from_rotation_vector

FAST_TAKES = (
    "mocap/hdm05/HDM_bd_throwBasketball_001_120.amc",
    "corpus/bvh/bandai_namco/dataset-1_run_angry_001.bvh",
    "corpus/bvh/assimp_boxing_toes/Boxing_Toes.bvh",
)


@pytest.fixture(scope="module")
def walk(recordings) -> Motion:
    take = read_recording(recordings / "mocap" / "cmu_walk" / "07_01.bvh").slice(1, 317)
    return at_30_hz(take)


def at_30_hz(take: Motion) -> Motion:
    step = round(take.frame_rate / 30.0)
    return Motion(
        take.skeleton,
        take.rotations[::step],
        take.root_positions[::step],
        take.frame_rate / step,
    )


def off(take: Motion, joint: int, frames: slice, degrees: float) -> Motion:
    """Rotate a joint by a constant in these frames."""
    rotations = take.rotations.copy()
    error = quaternion_from_rotation_vector([0.0, np.radians(degrees), 0.0])
    rotations[frames, joint] = multiply(rotations[frames, joint], error)
    return take.with_poses(rotations)


@pytest.mark.parametrize("path", FAST_TAKES)
def test_fast_movement_has_no_spikes(recordings, path):
    take = at_30_hz(read_recording(recordings / path))
    rule = SpikeRule(5.0, np.radians(8.0), 0.02)
    held = np.zeros((take.n_frames, take.n_joints + 1), dtype=bool)
    signals = extract_signals(take, held, rule, lambda *_: None)

    confirmed = confirm_spikes(take, signals, ())

    assert sum(signal.spikes.sum() for signal in signals) >= 5
    assert not sum(signal.spikes.sum() for signal in confirmed)


@pytest.mark.parametrize("frames", [slice(30, 31), slice(30, 33), slice(30, 37)])
def test_error_in_a_walk_is_listed_in_all_its_frames(walk, frames):
    joint = walk.skeleton.index("RightForeArm")

    spikes = measure_quality(off(walk, joint, frames, 50.0)).spikes

    expected = np.zeros_like(spikes)
    expected[frames, joint] = True
    assert (spikes == expected).all()


def test_smaller_errors_than_the_settings_ask_for_are_not_listed(walk):
    take = off(walk, walk.skeleton.index("RightForeArm"), slice(30, 35), 55.0)

    settings = QualitySettings(min_rotation_jump=np.radians(60.0))

    assert measure_quality(take).spikes.any()
    assert not measure_quality(take, settings=settings).spikes.any()


def test_height_of_an_added_error_is_its_distance_from_the_movement(walk):
    joint = walk.skeleton.index("RightForeArm")

    quality = measure_quality(off(walk, joint, slice(30, 36), 50.0))

    (signal,) = (
        each for each in quality.signals if each.joint == "RightForeArm" and each.is_rotation
    )
    assert np.degrees(signal.deviation[31:35]) == pytest.approx(50.0, abs=15.0)


def test_errors_after_a_cut_are_found(walk, recordings):
    other = at_30_hz(read_recording(recordings / "mocap" / "cmu_walk" / "07_03.bvh")).slice(
        20, 80
    )
    joint, frame = walk.skeleton.index("RightForeArm"), walk.n_frames + 30
    joined = Motion(
        walk.skeleton,
        np.concatenate([walk.rotations, other.rotations]),
        np.concatenate([walk.root_positions, other.root_positions + 3.0]),
        walk.frame_rate,
    )

    quality = measure_quality(off(joined, joint, slice(frame, frame + 5), 55.0))

    assert quality.cuts == (walk.n_frames,)
    assert np.argwhere(quality.spikes).tolist() == [[frame + i, joint] for i in range(5)]


def test_take_of_many_outliers_lists_them(walk, rng):
    rotations = walk.rotations.copy()
    is_wrong = rng.random(rotations.shape[:2]) < 0.1
    errors = quaternion_from_rotation_vector(rng.normal(size=(*is_wrong.shape, 3)))
    rotations[is_wrong] = multiply(rotations, errors)[is_wrong]
    signalled = [not walk.skeleton.is_end_site(joint) for joint in range(walk.n_joints)]

    spikes = measure_quality(walk.with_poses(rotations)).spikes

    assert spikes[is_wrong & signalled].mean() > 0.8


def test_nothing_observed_is_measured_without_spikes(walk):
    nothing = walk.with_poses(np.full_like(walk.rotations, np.nan))
    assert not measure_quality(nothing).spikes.any()
