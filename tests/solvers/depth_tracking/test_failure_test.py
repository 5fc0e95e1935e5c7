"""Wrong poses are told from right ones, by what was learned and by the paper's thresholds."""

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


def judged(pose, picture):
    free = PoseEquations(np.eye(36), np.zeros(36), 0.0)
    found = Registered(render_hypothesis(BODY, pose, CAMERA), free, 1)
    return fit_quality(BODY, found, Observation(CAMERA, picture), LIMIT)


def moved(**coordinates):
    pose = NATURAL.copy()
    for name, value in coordinates.items():
        pose[COORDINATES.index(name)] += value
    return pose


@pytest.mark.parametrize("test", list(FailureTest))
def test_the_true_pose_has_not_failed_and_one_aside_has(test):
    picture = drawn(NATURAL)

    assert not has_failed(judged(NATURAL, picture), test)
    assert has_failed(judged(moved(rootX=0.3), picture), test)
    assert has_failed(judged(moved(rootZ=0.3), picture), test)
    assert has_failed(quality_without_actor(), test)


def test_failure_probability_grows_with_the_offset():
    picture = drawn(NATURAL)
    chances = [
        failure_probability(judged(moved(rootX=aside), picture))
        for aside in np.arange(7) * 0.05
    ]
    assert np.all(np.diff(chances) > 0.0) and 0.0 < chances[0] < chances[-1] < 1.0


def test_features_are_counted_on_the_pixels():
    """Half of the actor is hidden: counted a second way, on whole pictures."""
    picture = drawn(NATURAL)
    picture[:, :80] = 0.0
    pose = moved(rootX=0.05, rootZ=-0.15)
    ours = drawn(pose)

    told = dict(zip(FEATURES, failure_features(judged(pose, picture)), strict=True))

    both = (ours > 0.0) & (picture > 0.0)
    assert np.isclose(told["off actor"], 1.0 - both.sum() / (ours > 0.0).sum())
    assert np.isclose(told["unexplained"], 1.0 - both.sum() / (picture > 0.0).sum())
    near = both & (picture - ours > LIMIT)
    assert np.isclose(told["too near"], near.sum() / (ours > 0.0).sum())
    assert told["too near"] > 0.3


def test_the_published_test_needs_both_depth_and_overlap():
    fine = judged(NATURAL, drawn(NATURAL))._replace(residual=0.024, coverage=0.91)

    assert not has_failed(fine, FailureTest.PUBLISHED)
    assert has_failed(fine._replace(residual=0.026), FailureTest.PUBLISHED)
    assert has_failed(fine._replace(coverage=0.89), FailureTest.PUBLISHED)
    assert has_failed(fine._replace(residual=np.nan), FailureTest.PUBLISHED)


def test_the_recording_of_the_fixtures_shows_the_same_body():
    poses = waving(2)
    assert not has_failed(judged(poses[1], recorded(poses).frame(1)), FailureTest.LEARNED)
