"""Overlapping limbs push each other apart in proportion to the overlap."""

import numpy as np
from drawn_bodies import CAMERA, posed
from numpy.testing import assert_allclose

from solvers.depth_tracking.body.coordinates import COORDINATES
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.normal_equations import (
    equations_in_coordinates,
    segment_equations,
    solve_step,
)
from solvers.depth_tracking.body.pose_priors import natural_stance
from solvers.depth_tracking.body.tables import CAPSULE_SEGMENTS
from solvers.depth_tracking.terms.hypothesis import render_hypothesis
from solvers.depth_tracking.terms.overlap import (
    RADIUS_FRACTION,
    _closest_points,
    separation_term,
)

BODY = default_body()


def test_closest_points_of_segments_equal_a_fine_search(rng):
    first, second = rng.normal(size=(2, 20, 2, 3))

    near, far = _closest_points(first, second)

    fractions = np.linspace(0.0, 1.0, 401)
    for pair in range(20):
        a = first[pair, 0] + fractions[:, None] * (first[pair, 1] - first[pair, 0])
        b = second[pair, 0] + fractions[:, None] * (second[pair, 1] - second[pair, 0])
        minimum = np.linalg.norm(a[:, None] - b, axis=-1).min()
        assert_allclose(np.linalg.norm(near[pair] - far[pair]), minimum, atol=0.01)


def test_separation_term_ignores_adjacent_legs():
    pose = posed(leftFemurZ=0.15, rightFemurZ=0.15, leftHumerusZ=0.5, rightHumerusZ=0.5)
    rows = separation_term(render_hypothesis(BODY, pose, CAMERA), 1.0)
    assert not len(rows.residuals)


def test_separation_term_separates_crossed_legs():
    pose = posed(leftFemurZ=-0.25, rightFemurZ=-0.25)
    overlaps = []
    for _ in range(15):
        hypothesis = render_hypothesis(BODY, pose, CAMERA)
        rows = separation_term(hypothesis, 1e4)
        overlaps.append(rows.residuals.max(initial=0.0))
        equations = equations_in_coordinates([segment_equations(rows)], hypothesis.twists)
        pose = pose + solve_step(equations, np.full(36, 10.0))
    assert overlaps[0] > 0.02
    assert overlaps[-1] < 0.1 * overlaps[0]
    assert RADIUS_FRACTION < 1.0


def test_separation_term_moves_both_limbs_equally():
    rows = separation_term(
        render_hypothesis(BODY, posed(leftFemurZ=-0.3, rightFemurZ=-0.3), CAMERA), 1.0
    )
    n_pairs = len(rows.residuals) // 2
    assert n_pairs > 0
    assert_allclose(rows.directions[:n_pairs], -rows.directions[n_pairs:])
    assert (CAPSULE_SEGMENTS[rows.capsules[:n_pairs]]
            != CAPSULE_SEGMENTS[rows.capsules[n_pairs:]]).all()  # fmt: skip


def test_natural_stance_weighs_the_trunk_more_than_limbs():
    requested = natural_stance(np.ones(36), 2.0, 5.0)
    assert_allclose(requested.vector[:6], 0.0)
    trunk, limb = (COORDINATES.index(name) for name in ("lowerBackZ", "leftFemurX"))
    assert requested.vector[trunk] < requested.vector[limb] < 0.0
    assert requested.vector[COORDINATES.index("rightAnkle")] == -5.0
    assert_allclose(requested.cost, 0.5 * np.trace(requested.matrix))
