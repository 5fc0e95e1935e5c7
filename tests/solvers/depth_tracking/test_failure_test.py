"""Detect wrong poses by a learned probability and by the paper's thresholds."""

import numpy as np
import pytest
from drawn_bodies import CAMERA, NATURAL, drawn, recorded, waving

from solvers.depth_tracking.body.coordinates import COORDINATES
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.normal_equations import PoseEquations
from solvers.depth_tracking.terms.hypothesis import render_hypothesis
from solvers.depth_tracking.terms.observation import Observation
from solvers.depth_tracking.tracking.failure_test import (
    FEATURES,
    FailureTest,
    failure_features,
    failure_probability,
    has_failed,
)
from solvers.depth_tracking.tracking.fit_quality import fit_quality, quality_without_actor
from solvers.depth_tracking.tracking.register_pose import Registered

BODY = default_body()
LIMIT = 0.08


def quality_of(pose, image):
    free = PoseEquations(np.eye(36), np.zeros(36), 0.0)
    found = Registered(render_hypothesis(BODY, pose, CAMERA), free, 1)
    return fit_quality(BODY, found, Observation(CAMERA, image), LIMIT)


def moved_pose(**coordinates):
    pose = NATURAL.copy()
    for name, value in coordinates.items():
        pose[COORDINATES.index(name)] += value
    return pose


@pytest.mark.parametrize("test", list(FailureTest))
def test_offset_pose_has_failed_and_true_pose_has_not(test):
    image = drawn(NATURAL)

    assert not has_failed(quality_of(NATURAL, image), test)
    assert has_failed(quality_of(moved_pose(rootX=0.3), image), test)
    assert has_failed(quality_of(moved_pose(rootZ=0.3), image), test)
    assert has_failed(quality_without_actor(), test)


def test_failure_probability_grows_with_the_offset():
    image = drawn(NATURAL)
    chances = [
        failure_probability(quality_of(moved_pose(rootX=offset), image))
        for offset in np.arange(7) * 0.05
    ]
    assert np.all(np.diff(chances) > 0.0) and 0.0 < chances[0] < chances[-1] < 1.0


def test_features_equal_counts_of_pixels():
    """Half of the actor is occluded; count on the complete images."""
    image = drawn(NATURAL)
    image[:, :80] = 0.0
    pose = moved_pose(rootX=0.05, rootZ=-0.15)
    result = drawn(pose)

    features = dict(zip(FEATURES, failure_features(quality_of(pose, image)), strict=True))

    both = (result > 0.0) & (image > 0.0)
    assert np.isclose(features["off actor"], 1.0 - both.sum() / (result > 0.0).sum())
    assert np.isclose(features["unexplained"], 1.0 - both.sum() / (image > 0.0).sum())
    near = both & (image - result > LIMIT)
    assert np.isclose(features["too near"], near.sum() / (result > 0.0).sum())
    assert features["too near"] > 0.3


def test_published_test_needs_both_depth_and_overlap():
    fine = quality_of(NATURAL, drawn(NATURAL))._replace(residual=0.024, coverage=0.91)

    assert not has_failed(fine, FailureTest.PUBLISHED)
    assert has_failed(fine._replace(residual=0.026), FailureTest.PUBLISHED)
    assert has_failed(fine._replace(coverage=0.89), FailureTest.PUBLISHED)
    assert has_failed(fine._replace(residual=np.nan), FailureTest.PUBLISHED)


def test_fixture_recording_shows_the_same_body():
    poses = waving(2)
    assert not has_failed(quality_of(poses[1], recorded(poses).frame(1)), FailureTest.LEARNED)
