"""Compare the derivatives of the body fit with finite differences."""

import numpy as np
import pytest
from marked_bodies import markers_on
from numpy.testing import assert_allclose

from solvers.markers.body import Poses
from solvers.markers.build_body import build_body
from solvers.markers.fit_body import MAX_STEPS, body_slopes, fit_body, measures_of
from solvers.markers.fit_poses import (
    _prior_residuals,
    apply_step,
    cost_of,
    fit_poses,
    marker_slopes,
)
from solvers.markers.joint_centers import chord, joint_centers
from solvers.markers.marker_sets import find_marker_set
from solvers.samples import GaitSettings, walking_gait

STEP = 1e-6


@pytest.fixture(scope="module")
def initial_fit():
    """A body, the observed markers, and poses with small errors."""
    tracks = markers_on(walking_gait(GaitSettings(duration=0.5, frame_rate=20.0)))
    found = find_marker_set(tracks.names).markers
    landmarks = {
        landmark: tracks.positions[:, tracks.names.index(name)]
        for landmark, name in found.items()
    }
    centers = joint_centers(landmarks)
    body, rotations = build_body(centers, landmarks)
    observed = np.stack([landmarks[marker.landmark] for marker in body.markers], axis=1)
    poses = Poses(rotations, centers.positions["hips"])
    rng = np.random.default_rng(1)
    poses = apply_step(
        body, poses, 0.05 * rng.normal(size=(len(observed), 3 + 3 * len(body.rotating_joints)))
    )
    return body, observed, poses


def test_pose_derivatives_equal_finite_differences(initial_fit):
    body, _, poses = initial_fit
    slopes = marker_slopes(body, body.body_in_pose(poses))

    for unknown in range(slopes.shape[-1]):
        step = np.zeros((len(poses.roots), slopes.shape[-1]))
        step[:, unknown] = STEP
        ahead = body.body_in_pose(apply_step(body, poses, step)).markers
        behind = body.body_in_pose(apply_step(body, poses, -step)).markers
        assert_allclose(slopes[..., unknown], (ahead - behind) / (2 * STEP), atol=1e-8)


def test_pose_prior_derivatives_equal_finite_differences(initial_fit):
    body, _, poses = initial_fit
    _, slopes = _prior_residuals(body, poses)

    for unknown in range(slopes.shape[-1]):
        step = np.zeros((len(poses.roots), slopes.shape[-1]))
        step[:, unknown] = STEP
        ahead, _ = _prior_residuals(body, apply_step(body, poses, step))
        behind, _ = _prior_residuals(body, apply_step(body, poses, -step))
        assert_allclose(slopes[..., unknown], (ahead - behind) / (2 * STEP), atol=1e-5)


def test_body_derivatives_equal_finite_differences(initial_fit):
    body, _, poses = initial_fit
    measures = measures_of(body)
    slopes = body_slopes(body, body.body_in_pose(poses), measures)

    for number, moved in enumerate(measures.joints):
        offsets = body.offsets.copy()
        for joint, axis, sign in moved:
            offsets[joint, axis] += sign * STEP
        ahead = body.with_offsets(offsets, body.marker_offsets).body_in_pose(poses).markers
        change = (ahead - body.body_in_pose(poses).markers) / STEP
        assert_allclose(slopes[..., number], change, atol=1e-6)


def test_fit_reduces_the_cost_and_converges(initial_fit):
    body, observed, poses = initial_fit

    fitted = fit_poses(body, observed, poses)
    again = fit_poses(body, observed, fitted)

    assert (cost_of(body, observed, fitted) < cost_of(body, observed, poses)).all()
    assert_allclose(cost_of(body, observed, again), cost_of(body, observed, fitted), rtol=0.02)


def test_fitted_body_reduces_the_marker_error(initial_fit):
    body, observed, poses = initial_fit
    fitted = fit_poses(body, observed, poses)

    better, refitted = fit_body(body, observed, fitted)

    assert (
        cost_of(better, observed, refitted).sum() < 0.5 * cost_of(body, observed, fitted).sum()
    )
    left, right = better.index["leftLowerLeg"], better.index["rightLowerLeg"]
    assert_allclose(better.offsets[left], better.offsets[right] * (-1.0, 1.0, 1.0))


def test_chord_forms_a_right_angle_at_the_joint():
    start, marker = np.zeros((1, 3)), np.array([[0.1, 0.02, -0.4]])

    joint = chord(start, marker, np.array([[1.0, 0.0, 0.0]]), 0.06)

    assert_allclose(np.linalg.norm(marker - joint), 0.06)
    assert_allclose(np.sum((marker - joint) * (joint - start)), 0.0, atol=1e-12)
    assert joint[0, 0] < marker[0, 0]


def test_fit_of_poses_ends_where_its_cost_hardly_falls(initial_fit, monkeypatch):
    body, observed, poses = initial_fit
    fitted = fit_poses(body, observed, poses)
    steps = []
    monkeypatch.setattr(
        "solvers.markers.fit_poses.apply_step",
        lambda *step: steps.append(step) or apply_step(*step),
    )

    fit_poses(body, observed, fitted)

    assert 0 < len(steps) < 6


def test_fit_of_a_body_ends_where_its_cost_hardly_falls(initial_fit):
    steps = []

    fit_body(*initial_fit, progress=lambda fraction, _: steps.append(fraction))

    assert len(steps) < MAX_STEPS
