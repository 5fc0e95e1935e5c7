"""Estimate lengths and radii from depth images of a moving body."""

import numpy as np
import pytest
from drawn_bodies import CAMERA, NATURAL, recorded, segment_image, waving
from numpy.testing import assert_allclose

from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.shape import MEASURES, resize_body, shape_jacobian
from solvers.depth_tracking.body.tables import LENGTHS
from solvers.depth_tracking.capturing.refine_body import (
    RefineBodySettings,
    pose_jacobian,
    refine_body,
)
from solvers.depth_tracking.terms.depth_image import depth_image_term
from solvers.depth_tracking.terms.hypothesis import render_hypothesis
from solvers.depth_tracking.terms.observation import Observation
from solvers.depth_tracking.terms.pixel_groups import group_pixels
from solvers.depth_tracking.tracking.track_pose import track_pose
from solvers.errors import InvalidMotionError

BODY = default_body()


def depth_rows(body, pose):
    hypothesis = render_hypothesis(body, pose, CAMERA)
    observation = Observation(CAMERA, hypothesis.image.depth_image())
    groups = group_pixels(hypothesis, observation, 0.08)
    return hypothesis, depth_image_term(hypothesis, observation, groups, 1.0)


@pytest.mark.parametrize("measure", MEASURES)
def test_measure_jacobian_equals_differences_of_rendered_depth(measure):
    hypothesis, rows = depth_rows(BODY, NATURAL)
    index, size = MEASURES.index(measure), 1e-5
    exact = shape_jacobian(BODY, hypothesis.frames, rows)[:, index]
    images = [
        render_hypothesis(
            resize_body(BODY, sign * size * np.eye(len(MEASURES))[index]), NATURAL, CAMERA
        )
        for sign in (1.0, -1.0)
    ]
    pixels = hypothesis.image.pixels
    high, low = (one.image.depth_image().ravel()[pixels] for one in images)
    same = segment_image(images[0].image) == segment_image(images[1].image)
    facing = -np.einsum("ni,ni->n", hypothesis.normals, hypothesis.rays) > 0.4
    inner = same.ravel()[pixels] & facing & (high > 0.0) & (low > 0.0)

    errors = np.abs((high - low)[inner] / (2 * size) - exact[inner])

    # A neck or a foot rotates slightly as its length grows; few pixels show them.
    assert (errors < 2e-3 + 0.02 * np.abs(exact[inner])).mean() > 0.96


def test_pose_jacobian_equals_that_of_the_tracker():
    hypothesis, rows = depth_rows(BODY, NATURAL)
    twists = hypothesis.twists[hypothesis.segments]
    moved = np.cross(twists[:, :3], rows.points[:, :, None], axis=1) + twists[:, 3:]
    expected = np.einsum("ni,nik->nk", rows.directions, moved)

    assert_allclose(pose_jacobian(hypothesis, rows), expected, atol=1e-9)


def test_resizing_keeps_both_sides_equal():
    body = resize_body(BODY, 0.1 * np.arange(len(MEASURES)) / len(MEASURES))
    assert_allclose(body.symmetric().lengths, body.lengths)
    assert_allclose(body.symmetric().radii, body.radii)


def test_refine_body_recovers_the_rendered_body():
    """The initial body is 5 % shorter and 12 % thinner, tracked as accurately as possible."""
    truth = waving(40)
    actor = BODY.with_lengths(leftUpperArm=0.28, rightUpperArm=0.28)
    recording = recorded(truth, actor)
    wrong = type(BODY)(0.95 * BODY.lengths, 0.88 * BODY.radii)
    tracked = track_pose(recording, wrong, truth[0])

    found = refine_body(recording, wrong, tracked.poses)

    columns = [
        LENGTHS.index(n) for n in ("leftUpperArm", "leftUpperLeg", "leftLowerLeg", "chest")
    ]
    before = np.abs(np.log(wrong.lengths / actor.lengths))[columns].mean()
    after = np.abs(np.log(found.lengths / actor.lengths))[columns].mean()
    assert after < 0.6 * before
    radii = [np.abs(np.log(one.radii / actor.radii)).mean() for one in (wrong, found)]
    # The mean includes feet, hands and shoulders, which have few pixels.
    assert radii[1] < 0.75 * radii[0]


def test_exact_body_stays_unchanged():
    truth = waving(10)
    found = refine_body(
        recorded(truth), BODY, truth, settings=RefineBodySettings(n_frames=4, rounds=2)
    )
    assert_allclose(found.lengths, BODY.lengths, rtol=0.005)
    assert_allclose(found.radii, BODY.radii, rtol=0.01)


def test_refine_body_raises_for_invalid_input():
    recording = recorded(waving(2))
    with pytest.raises(InvalidMotionError, match=r"not \(2, 36\)"):
        refine_body(recording, BODY, np.zeros((3, 36)))
    empty = DepthRecording(CAMERA, 2, 30.0, lambda _: np.zeros((120, 160), dtype=np.float32))
    with pytest.raises(InvalidMotionError, match="No frame shows an actor"):
        refine_body(empty, BODY, np.zeros((2, 36)))
