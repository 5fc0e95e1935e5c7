"""Both methods of reconstruction together, on a walk whose left forearm is noisy behind the
body.
"""

from dataclasses import replace

import kinect_walks
import numpy as np
import pytest

from solvers import motion, samples
from solvers.motion import JointRecording, Sensor, forward_kinematics
from solvers.motion.humanoid import posture_joints
from solvers.motion.humanoid.posture_heading import rotate_about_vertical
from solvers.reconstruction import (
    ReconstructMethod,
    ReconstructSettings,
    ReliabilityMethod,
    ReliabilitySettings,
    measure_reliability,
    reconstruct,
    reconstruct_postures,
)
from solvers.reconstruction.complete_take import replacement_weights
from solvers.reconstruction.pose_completion import complete_postures
from solvers.reconstruction.published.posture_reconstruction import search_as_published
from solvers.reconstruction.published.residual_reconstruction import (
    ThreeTermSettings,
    reconstruct_published_residuals,
)
from solvers.reconstruction.reconstruct import shipped_residual_prior

OCCLUDED_FRAMES, HIDDEN = kinect_walks.OCCLUDED_FRAMES, [5, 6, 7]
OURS = (ReconstructMethod.BOTH, ReconstructMethod.POSTURES, ReconstructMethod.RESIDUALS)
VISIBLE = [joint for joint in range(20) if joint not in HIDDEN]


@pytest.fixture(scope="module")
def true():
    return kinect_walks.true_positions(samples, posture_joints)


@pytest.fixture(scope="module")
def walk(true):
    return kinect_walks.tracked_walk(motion, true)


def mean_error(positions, true, joints, frames=slice(None)):
    return float(np.linalg.norm((positions - true)[frames][:, joints], axis=-1).mean())


@pytest.mark.parametrize("method", OURS)
@pytest.mark.parametrize("causal", [False, True])
def test_reconstruction_reduces_the_error_of_a_noisy_forearm(walk, true, method, causal):
    settings = ReconstructSettings(method=method, causal=causal)
    found = reconstruct(walk, settings=settings).tracks.positions
    before = mean_error(walk.tracks.positions, true, HIDDEN, OCCLUDED_FRAMES)
    assert mean_error(found, true, HIDDEN, OCCLUDED_FRAMES) < (0.7 if causal else 0.5) * before


def test_published_methods_equal_their_separate_verbs(walk):
    signs = measure_reliability(
        walk, settings=ReliabilitySettings(method=ReliabilityMethod.PUBLISHED)
    )
    separate = reconstruct_postures(walk, reliability=signs, complete=search_as_published)
    chosen = ReconstructSettings(method=ReconstructMethod.PUBLISHED_POSTURES)
    complete = reconstruct(walk, settings=chosen)
    np.testing.assert_array_equal(complete.tracks.positions, separate.tracks.positions)
    np.testing.assert_array_equal(complete.motion.rotations, separate.motion.rotations)
    assert "stochastic search" in complete.method

    v2 = replace(walk, sensor=Sensor.KINECT_V2)
    separate = reconstruct_published_residuals(
        v2, shipped_residual_prior(), settings=ThreeTermSettings()
    )
    chosen = ReconstructSettings(method=ReconstructMethod.PUBLISHED_RESIDUALS, shift=True)
    complete = reconstruct(v2, settings=chosen)
    np.testing.assert_array_equal(complete.tracks.positions, separate.tracks.positions)
    moved = mean_error(complete.tracks.positions, walk.tracks.positions, VISIBLE)
    other = reconstruct(walk, settings=chosen)  # whose errors the prior does not know
    assert mean_error(other.tracks.positions, walk.tracks.positions, VISIBLE) < moved


def test_postures_improve_joints_that_residuals_only_smooth(walk, true):
    missing = walk.tracks.positions.copy()
    missing[OCCLUDED_FRAMES, HIDDEN[0] : HIDDEN[-1] + 1] = np.nan
    unobserved = JointRecording(walk.tracks.with_positions(missing), None, walk.sensor)
    error = {
        method: mean_error(
            reconstruct(
                unobserved, settings=ReconstructSettings(method=method)
            ).tracks.positions,
            true, HIDDEN, OCCLUDED_FRAMES,
        )
        for method in (ReconstructMethod.BOTH, ReconstructMethod.RESIDUALS)
    }  # fmt: skip
    assert error[ReconstructMethod.BOTH] < 0.7 * error[ReconstructMethod.RESIDUALS]


def test_observed_joints_keep_their_positions(walk, true):
    found = reconstruct(walk)
    assert mean_error(found.tracks.positions, walk.tracks.positions, VISIBLE) < 0.015
    assert found.confidence[:, VISIBLE].mean() > 0.7
    assert (
        found.confidence[OCCLUDED_FRAMES][:, HIDDEN].mean()
        < found.confidence[:, VISIBLE].mean() - 0.1
    )


def test_bones_have_constant_lengths(walk):
    result = reconstruct(walk).motion
    joints = forward_kinematics(result).positions
    bones = np.linalg.norm(
        joints[:, 1:] - joints[:, list(result.skeleton.parents[1:])], axis=-1
    )
    assert bones.std(axis=0).max() < 1e-9


def test_heading_and_position_do_not_matter(walk):
    angles, shift = np.full(walk.n_frames, 1.2), np.array([2.0, -3.0, 0.0])
    moved = walk.with_tracks(
        walk.tracks.with_positions(rotate_about_vertical(walk.tracks.positions, angles) + shift)
    )
    result, moved_result = (
        reconstruct(walk).tracks.positions,
        reconstruct(moved).tracks.positions,
    )
    np.testing.assert_allclose(
        rotate_about_vertical(result, angles) + shift, moved_result, atol=1e-3
    )


def test_reconstruction_repeats_and_leaves_the_input_unchanged(walk):
    original = walk.tracks.positions.copy()
    one, other = reconstruct(walk), reconstruct(walk)
    np.testing.assert_array_equal(one.tracks.positions, other.tracks.positions)
    np.testing.assert_array_equal(walk.tracks.positions, original)


def test_inferred_joints_are_reconstructed_more_at_lower_weight(walk, true):
    clean = walk.with_tracks(walk.tracks.with_positions(true))
    moved = [
        mean_error(
            reconstruct(
                clean, settings=ReconstructSettings(inferred=count)
            ).tracks.positions,
            true, HIDDEN, OCCLUDED_FRAMES,
        )
        for count in (0.0, 0.5, 1.0)
    ]  # fmt: skip
    assert moved[0] > moved[1] > 0.5 * moved[2]
    assert moved[1] < 0.02


def reversed_after(walk, start):
    """Reverse the frames from `start` on; the bone lengths stay the same."""
    order = np.arange(len(walk.tracks.positions))
    order[start:] = order[start:][::-1]
    return frames_of(walk, order)


def frames_of(walk, order):
    tracks = walk.tracks.with_positions(walk.tracks.positions[order])
    return JointRecording(tracks, walk.tracking_state[order], walk.sensor)


@pytest.fixture
def one_body(monkeypatch):
    """Measure body size and mean errors on the first take only, as a calibration would."""
    for name in ("_fit_library_to_actor", "_measure_errors"):
        monkeypatch.setattr(complete_postures, name, frozen(getattr(complete_postures, name)))


def frozen(measure):
    results = []

    def first(*given):
        if not results:
            results.append(measure(*given))
        return results[0]

    return first


@pytest.mark.parametrize("method", OURS)
def test_causal_joints_ignore_later_frames_except_for_the_body(walk, method, one_body):
    short = frames_of(walk, np.arange(15, 75))
    far = {}
    for causal in (True, False):
        settings = ReconstructSettings(method=method, causal=causal)
        one, other = (
            reconstruct(take, settings=settings).tracks.positions[:40]
            for take in (short, reversed_after(short, 40))
        )
        far[causal] = float(np.abs(one - other).max())
    assert far[True] < 3e-4 < 1e-3 < far[False]


def test_wrong_joint_is_replaced_and_an_uncertain_one_stays_near():
    """A library pose half a meter off replaces a joint only if nothing shows where it is."""
    reliability, distance = np.array([[0.0, 0.1]]), np.full((1, 2), 0.5)

    wrong, uncertain = replacement_weights(distance > 0.0, reliability, distance)[0]

    assert wrong == 1.0
    assert uncertain < 0.1
