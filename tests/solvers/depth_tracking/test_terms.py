"""Equations of each term equal the derivatives of its definition."""

import numpy as np
import pytest
from drawn_bodies import CAMERA, NATURAL, drawn, observed, posed, segment_image
from numpy.testing import assert_allclose

from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.normal_equations import (
    SurfaceRows,
    equations_in_coordinates,
    rows_toward_targets,
    segment_equations,
    solve_step,
)
from solvers.depth_tracking.body.tables import CAPSULES, SEGMENTS
from solvers.depth_tracking.terms.closest_surface import closest_surface, closest_surface_term
from solvers.depth_tracking.terms.depth_image import depth_gradients, depth_image_term
from solvers.depth_tracking.terms.extra_depth import extra_depth_term
from solvers.depth_tracking.terms.free_space import off_actor_term, too_near_term
from solvers.depth_tracking.terms.hypothesis import render_hypothesis
from solvers.depth_tracking.terms.observation import Observation
from solvers.depth_tracking.terms.pixel_groups import group_pixels
from solvers.depth_tracking.terms.silhouette import silhouette_term

BODY = default_body()


def point_velocities(hypothesis, directions):
    """Speed of visible points along directions (n, 3) by each coordinate, (n, 36)."""
    twists = hypothesis.twists[hypothesis.segments]
    speeds = np.cross(twists[:, :3], hypothesis.points[:, :, None], axis=1) + twists[:, 3:]
    return np.einsum("ni,nik->nk", directions, speeds)


def test_segment_equations_equal_the_dense_ones(rng):
    """One 6 x 6 matrix per segment replaces a Jacobian with a row per pixel."""
    hypothesis = render_hypothesis(BODY, NATURAL, CAMERA)
    n = len(hypothesis.points)
    directions, residuals = rng.normal(size=(n, 3)), rng.normal(size=n)
    weights = rng.uniform(0.5, 2.0, size=n)

    rows = SurfaceRows(
        hypothesis.points, directions, residuals, weights, hypothesis.image.capsules
    )

    found = equations_in_coordinates([segment_equations(rows)], hypothesis.twists)

    jacobian = point_velocities(hypothesis, directions)
    assert_allclose(found.matrix, jacobian.T @ (weights[:, None] * jacobian), atol=1e-8)
    assert_allclose(found.vector, jacobian.T @ (weights * residuals), atol=1e-8)
    assert_allclose(found.cost, 0.5 * (weights * residuals**2).sum())


def test_point_equations_equal_those_along_three_axes(rng):
    points, targets = rng.normal(size=(2, 7, 3))
    weights, capsules = rng.uniform(size=7), rng.integers(0, 19, size=7)

    found = segment_equations(rows_toward_targets(points, targets, weights, capsules))

    parts = [
        segment_equations(SurfaceRows(
            points, np.tile(axis, (7, 1)), (targets - points) @ axis, weights, capsules))
        for axis in np.eye(3)
    ]  # fmt: skip
    assert_allclose(found.matrices, sum(part.matrices for part in parts), atol=1e-12)
    assert_allclose(found.vectors, sum(part.vectors for part in parts), atol=1e-12)


def test_depth_gradient_equals_differences_of_rendered_depth():
    """Central differences of rendered images, away from silhouettes and part boundaries."""
    hypothesis, size = render_hypothesis(BODY, NATURAL, CAMERA), 1e-5
    exact = point_velocities(hypothesis, depth_gradients(hypothesis))
    pixels = hypothesis.image.pixels
    facing = -np.einsum("ni,ni->n", hypothesis.normals, hypothesis.rays) > 0.4
    for coordinate in (0, 2, 3, 5, 8, 11, 14, 16, 18, 20, 21, 23, 29, 33):
        images = [
            render_hypothesis(
                BODY, NATURAL + sign * size * np.eye(36)[coordinate], CAMERA
            ).image
            for sign in (1.0, -1.0)
        ]
        high, low = (image.depth_image().ravel()[pixels] for image in images)
        same = (segment_image(images[0]) == segment_image(images[1])).ravel()[pixels]
        inner = facing & same & (high > 0.0) & (low > 0.0)
        differences = (high - low)[inner] / (2 * size)
        assert inner.sum() > 900
        # Kinks where one capsule of a segment meets another are a few pixels only.
        errors = np.abs(differences - exact[inner, coordinate])
        assert (errors < 1e-4).mean() > 0.99


@pytest.mark.parametrize("offset", [(0.03, 0.0), (0.0, -0.03)])
def test_silhouette_term_pulls_back_to_the_outline(offset):
    start = NATURAL.copy()
    start[:2] += offset
    hypothesis = render_hypothesis(BODY, start, CAMERA)

    requested = equations_in_coordinates(
        [segment_equations(silhouette_term(hypothesis, observed(NATURAL), 1.0))],
        hypothesis.twists,
    ).vector[:2]

    assert requested @ np.array(offset) < 0.0
    assert abs(requested @ np.array(offset)) > 0.9 * np.linalg.norm(requested) * np.linalg.norm(
        offset
    )


def test_terms_have_zero_residuals_at_the_true_pose():
    hypothesis, observation = render_hypothesis(BODY, NATURAL, CAMERA), observed(NATURAL)
    groups = group_pixels(hypothesis, observation, 0.08)

    for term in (
        depth_image_term(hypothesis, observation, groups, 1.0),
        silhouette_term(hypothesis, observation, 1.0),
        closest_surface_term(hypothesis, observation.points, 1.0, 0.05),
    ):
        assert len(term.residuals) > 300
        assert_allclose(term.residuals, 0.0, atol=1e-9)


def test_terms_of_disagreeing_pixels_have_no_rows_at_the_true_pose():
    hypothesis, observation = render_hypothesis(BODY, NATURAL, CAMERA), observed(NATURAL)
    groups = group_pixels(hypothesis, observation, 0.08)

    for term in (
        extra_depth_term(hypothesis, observation, groups, 1.0, 0.08),
        off_actor_term(hypothesis, observation, groups, 1.0, 0.05),
        too_near_term(hypothesis, observation, groups, 1.0, 0.05),
    ):
        assert not len(term.residuals)


@pytest.mark.parametrize(("term", "axis", "offset"), [
    (off_actor_term, 0, 0.05), (off_actor_term, 0, -0.05), (off_actor_term, 1, 0.05),
    (too_near_term, 2, -0.12), (extra_depth_term, 0, 0.05), (extra_depth_term, 2, -0.12),
])  # fmt: skip
def test_terms_of_disagreeing_pixels_pull_a_displaced_body_back(term, axis, offset):
    """By no more than the offset, but for one pixel: 2 cm at this distance."""
    start = NATURAL.copy()
    start[axis] += offset
    hypothesis, observation = render_hypothesis(BODY, start, CAMERA), observed(NATURAL)
    groups = group_pixels(hypothesis, observation, 0.08)

    rows = term(hypothesis, observation, groups, 1.0, 0.08)

    along = rows.residuals[rows.directions[:, axis] == 1.0]
    assert len(along) > 100
    assert along.mean() / offset < -0.25 and np.abs(along).max() < abs(offset) + 0.02


@pytest.mark.parametrize(("term", "axis", "offset", "n_axes"), [
    (off_actor_term, 0, 0.1, 2), (too_near_term, 2, -0.12, 3),
])  # fmt: skip
def test_weights_of_free_space_fall_with_the_distance(term, axis, offset, n_axes):
    start = NATURAL.copy()
    start[axis] += offset
    hypothesis, observation = render_hypothesis(BODY, start, CAMERA), observed(NATURAL)
    groups = group_pixels(hypothesis, observation, 0.08)

    rows = term(hypothesis, observation, groups, 8.0, 0.05)

    distances = np.linalg.norm(rows.residuals.reshape(-1, n_axes), axis=1)
    order, weights = np.argsort(distances), rows.weights[::n_axes]
    found = np.interp([0.05, 0.1], distances[order], weights[order])
    assert_allclose(found, [8.0 / 4.0, 8.0 / 25.0], atol=0.05)


def test_pairs_of_the_extra_depth_term_are_the_shortest_of_each_target():
    """The legs are not observed, so that many points have the same closest target."""
    picture = drawn(NATURAL)
    picture[70:] = 0.0
    hypothesis = render_hypothesis(BODY, NATURAL, CAMERA)
    observation = Observation(CAMERA, picture)
    groups = group_pixels(hypothesis, observation, 0.08)

    rows = extra_depth_term(hypothesis, observation, groups, 1.0, 0.005)

    targets = rows.points[::3] + rows.residuals.reshape(-1, 3)
    _, reached = observation.tree.query(targets)
    distances, nearest = observation.tree.query(hypothesis.points[groups.off_actor])
    shortest = [distances[nearest == target].min() for target in reached]
    assert len(set(reached)) == len(reached) < len(set(nearest))
    assert_allclose(np.linalg.norm(rows.residuals.reshape(-1, 3), axis=1), shortest)
    assert np.abs(rows.residuals[2::3]).max() <= 0.005


def test_pixel_groups_equal_those_of_the_paper():
    """An arm occludes the chest, and a raised arm differs from the hypothesis."""
    acted = posed(leftHumerusX=1.0, leftHumerusY=1.0, leftRadius=1.6, rightHumerusZ=1.4)
    hypothesis, observation = render_hypothesis(BODY, posed(), CAMERA), observed(acted)

    groups = group_pixels(hypothesis, observation, 0.08)

    together = [groups.comparable, groups.off_actor, groups.too_near, groups.too_far]
    assert sorted(np.concatenate(together)) == list(range(len(hypothesis.points)))
    assert (hypothesis.segments == SEGMENTS.index("chest"))[groups.too_far].sum() > 10
    arm = hypothesis.segments == SEGMENTS.index("rightLowerArm")
    assert arm[groups.off_actor].sum() > 0.7 * arm.sum()
    assert len(groups.uncovered) > 30
    assert set(observation.pixels) <= set(hypothesis.image.pixels) | set(groups.uncovered)
    back = group_pixels(render_hypothesis(BODY, acted, CAMERA), observed(posed()), 0.08)
    assert len(back.too_near) > 10


@pytest.mark.parametrize("distance", [-0.02, 0.03])
def test_closest_surface_of_a_round_limb_is_a_radius_from_its_axis(distance):
    hypothesis = render_hypothesis(BODY, posed(leftHumerusZ=1.2), CAMERA)
    limb = CAPSULES.index("leftLowerArm")
    frame = hypothesis.frames[SEGMENTS.index("leftLowerArm")]
    middle = frame[:3, :3] @ BODY.capsule_ends[limb].mean(axis=0) + frame[:3, 3]
    toward = -middle / np.linalg.norm(middle)
    toward -= frame[:3, 1] * (frame[:3, 1] @ toward)
    toward /= np.linalg.norm(toward)
    point = middle + (BODY.radii[limb, 0] + distance) * toward

    distances, normals, capsules = closest_surface(hypothesis, point[np.newaxis])

    assert capsules == limb
    assert_allclose(distances, distance, atol=1e-12)
    assert_allclose(normals[0], toward, atol=1e-12)


def test_step_of_every_depth_term_reduces_the_distance():
    """One step of each term, from 4 cm too near."""
    start = NATURAL.copy()
    start[2] -= 0.04
    hypothesis, observation = render_hypothesis(BODY, start, CAMERA), observed(NATURAL)
    groups = group_pixels(hypothesis, observation, 0.08)
    for term in (
        depth_image_term(hypothesis, observation, groups, 1.0),
        closest_surface_term(hypothesis, observation.points, 1.0, 0.2),
    ):
        change = solve_step(
            equations_in_coordinates([segment_equations(term)], hypothesis.twists),
            np.full(36, 0.1),
        )
        nearer = render_hypothesis(BODY, start + change, CAMERA).points[:, 2].mean()
        assert abs(nearer - observation.points[:, 2].mean()) < 0.03


def test_group_pixels_is_empty_for_an_empty_observation():
    empty = Observation(CAMERA, np.zeros((120, 160)))
    hypothesis = render_hypothesis(BODY, NATURAL, CAMERA)
    groups = group_pixels(hypothesis, empty, 0.08)

    assert len(groups.off_actor) == len(hypothesis.points)
    assert not len(groups.comparable) and not len(groups.uncovered)
    assert not len(extra_depth_term(hypothesis, empty, groups, 1.0, 0.08).residuals)
