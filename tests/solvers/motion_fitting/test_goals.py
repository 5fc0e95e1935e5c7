"""Derivatives of goals agree with differences; a goal is met where nothing opposes it."""

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import Motion, forward_kinematics
from solvers.motion_fitting import FittedMotion, fit_motion
from solvers.motion_fitting.goals import (
    BonePoint,
    FollowPosition,
    FollowRotation,
    FollowSource,
    HingeLimit,
    KeepSeparation,
    StayAbove,
    StayAtHeight,
    StayInPlace,
    StayStill,
    hinge_limit,
    knee_limit,
    with_bent_hinge,
)
from solvers.motion_fitting.goals.hinge_limit import hinge_axis, hinge_flexion
from solvers.motion_fitting.normal_equations import NormalEquations
from solvers.rotations import (
    angle_between,
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
)
from solvers.samples import GaitSettings, walking_gait

N_FRAMES = 12
LEG = ("LeftUpLeg", "LeftLeg", "LeftFoot")


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=1.0, frame_rate=30.0)).slice(0, N_FRAMES)


@pytest.fixture
def start(walk) -> FittedMotion:
    """The leg and the root may change."""
    return FittedMotion(walk, walk, tuple(walk.skeleton.index(name) for name in LEG))


@pytest.fixture
def shaken(start, rng) -> FittedMotion:
    """The same, a few degrees away from its source."""
    return start.moved(0.05 * rng.normal(size=(N_FRAMES, start.n_variables)))


def all_goals(start: FittedMotion, rng) -> dict[str, object]:
    """One goal of each kind."""
    _, knee, ankle = start.joints
    points = (BonePoint(ankle, np.array([0.0, 0.05, -0.06])), BonePoint(knee, np.zeros(3)))
    load = rng.dirichlet((1.0, 1.0), N_FRAMES)
    frames, steps = rng.uniform(size=(N_FRAMES, 3)), rng.uniform(size=(N_FRAMES - 1, 3))
    axis = hinge_axis(start, knee, ankle)
    return {
        "follow source": FollowSource(
            rng.uniform(0.1, 1.0, start.n_variables), rng.uniform(0.1, 1.0, start.n_variables)
        ),
        "in place": StayInPlace(points, load[1:], steps, 0.01),
        "wanted steps": StayInPlace(points, load[1:], steps, 0.01, 0.003 * steps),
        "above": StayAbove(points[0], frames[:, 0], 0.01),
        "at height": StayAtHeight(
            points, load, np.array([0.02, 0.4]), 0.01, frames[:, 0], 0.01
        ),
        "position": FollowPosition(points[0], rng.normal(size=(N_FRAMES, 3)), frames, 0.1),
        "separation": KeepSeparation(
            *points, rng.normal(size=(N_FRAMES, 3)), frames[:, 0], 0.1
        ),
        "rotation": FollowRotation(ankle, start.poses.rotations[:, ankle], 0.1),
        "still": StayStill(ankle, steps, 0.1),
        "hinge": HingeLimit(knee, ankle, axis, np.full(N_FRAMES, 1.5), 0.1),
    }


def equations(goal, fitted: FittedMotion) -> NormalEquations:
    found = NormalEquations(N_FRAMES, fitted.n_variables)
    goal.add_to(found, fitted)
    return found


KINDS = (
    "follow source", "in place", "wanted steps", "above", "at height", "position", "separation",
    "rotation", "still", "hinge",
)  # fmt: skip


@pytest.mark.parametrize("root_moves", [True, False])
@pytest.mark.parametrize("knee_is_hinge", [True, False])
@pytest.mark.parametrize("kind", KINDS)
def test_gradient_agrees_with_differences(start, rng, kind, root_moves, knee_is_hinge):
    """The derivative of a rotation vector is that of a small one, so the change is small."""
    _, knee, ankle = start.joints
    hinges = {knee: hinge_axis(start, knee, ankle)} if knee_is_hinge else {}
    start = FittedMotion(start.source, start.motion, start.joints, root_moves, hinges)
    fitted = start.moved(0.003 * rng.normal(size=(N_FRAMES, start.n_variables)))
    goal = all_goals(start, rng)[kind]
    direction = rng.normal(size=(N_FRAMES, fitted.n_variables))

    above, below = (
        equations(goal, fitted.moved(sign * 1e-6 * direction)).cost for sign in (1.0, -1.0)
    )

    gradient = equations(goal, fitted).gradient
    error = 0.005 * np.linalg.norm(gradient) * np.linalg.norm(direction)
    assert (above - below) / 2e-6 == pytest.approx(np.vdot(gradient, direction), abs=error)


def test_a_hinge_turns_about_its_axis_only(start, rng):
    _, knee, ankle = start.joints
    axis = hinge_axis(start, knee, ankle)
    start = FittedMotion(start.source, start.motion, start.joints, hinges={knee: axis})
    step = rng.normal(size=(N_FRAMES, start.n_variables))

    moved = start.moved(step)

    before, after = start.motion.rotations[:, knee], moved.motion.rotations[:, knee]
    rotations = rotation_vector_from_quaternion(multiply(after, inverse(before)))
    assert_allclose(rotations, step[:, start.columns(knee)] * axis, atol=1e-9)
    assert_allclose(moved.deviations()[:, start.columns(knee)] * axis, rotations, atol=1e-9)


def test_a_motion_without_goals_but_its_source_comes_back(start, shaken):
    n = start.n_variables
    follow = FollowSource(np.full(n, 0.1), np.full(n, 0.1))

    fit = fit_motion(shaken, [follow])

    assert fit.has_converged
    assert angle_between(fit.motion.rotations, start.source.rotations).max() < 1e-3
    assert_allclose(fit.motion.root_positions, start.source.root_positions, atol=1e-3)


def test_a_point_is_brought_where_it_is_wanted(start):
    """The ankle moves 3 cm forward, which the leg can reach."""
    ankle, n = start.joints[-1], start.n_variables
    wanted = start.poses.positions[:, ankle] + (0.0, -0.03, 0.01)
    position = FollowPosition(
        BonePoint(ankle, np.zeros(3)), wanted, np.ones((N_FRAMES, 3)), 1e-4
    )

    fit = fit_motion(start, [position, FollowSource(np.full(n, 0.1), np.full(n, 0.1))])

    assert fit.has_converged
    found = forward_kinematics(fit.motion).positions[:, ankle]
    assert_allclose(found, wanted, atol=1e-3)


def test_a_point_out_of_reach_is_approached_without_stretching(start):
    """The root stays, and the leg points at a place 2 m away."""
    start = FittedMotion(start.source, start.motion, start.joints, root_moves=False)
    hip, _, ankle = start.joints
    wanted = start.poses.positions[:, hip] + (0.0, -1.2, -1.6)
    position = FollowPosition(
        BonePoint(ankle, np.zeros(3)), wanted, np.ones((N_FRAMES, 3)), 0.01
    )
    follow = FollowSource(np.full(start.n_variables, 1.0), np.full(start.n_variables, 0.1))

    poses = forward_kinematics(fit_motion(start, [position, follow]).motion)

    reach = poses.positions[:, ankle] - poses.positions[:, hip]
    length = np.linalg.norm(start.source.skeleton.offsets[list(start.joints[1:])], axis=1).sum()
    assert (np.linalg.norm(reach, axis=1) > 0.92 * length).all()
    assert (np.linalg.norm(reach, axis=1) < length + 1e-9).all()
    assert (reach @ (0.0, -0.6, -0.8) > 0.9 * length).all()


def test_a_knee_keeps_its_limit(start):
    _, knee, ankle = start.joints
    axis = hinge_axis(start, knee, ankle)
    limit = HingeLimit(knee, ankle, axis, np.full(N_FRAMES, 0.8))
    n = start.n_variables

    fit = fit_motion(start, [limit, FollowSource(np.full(n, 0.5), np.full(n, 0.05))])

    after = FittedMotion(start.source, fit.motion, start.joints)
    assert (hinge_flexion(start, knee, ankle, axis) < 0.8).any()
    assert (hinge_flexion(after, knee, ankle, axis) > 0.75).all()


@pytest.mark.parametrize("flexion", [0.0, 0.02, 0.5, 2.9, -0.5])
def test_only_straight_limbs_are_bent_before_a_fit(start, flexion):
    """A knee that is bent, the wrong way too, starts as it is."""
    _, knee, ankle = start.joints
    axis = hinge_axis(start, knee, ankle)
    rotation = flexion - hinge_flexion(start, knee, ankle, axis)
    step = np.zeros((N_FRAMES, start.n_variables))
    step[:, start.columns(knee)] = rotation[:, None] * axis
    bent = start.moved(step)

    after = with_bent_hinge(bent, hinge_limit(bent, knee, ankle, axis, 0.1))

    expected = np.radians(3.0) if abs(flexion) < np.radians(3.0) else flexion
    assert_allclose(hinge_flexion(after, knee, ankle, axis), expected, atol=0.02)


@pytest.mark.parametrize("bend_deg", [-4.0, 0.0])
def test_a_knee_that_bends_backward_by_a_few_degrees_does_not_bend_farther(walk, bend_deg):
    """The axis of such a knee would be the reverse of a knee's."""
    hip, knee, ankle = (walk.skeleton.index(name) for name in LEG)
    rotations = walk.rotations.copy()
    rotations[:, knee] = quaternion_from_rotation_vector([np.radians(bend_deg), 0.0, 0.0])
    straight = walk.with_poses(rotations)
    start = FittedMotion(straight, straight, (hip, knee, ankle))

    limit = knee_limit(start, knee, ankle, 0.1)

    assert limit.axis @ (1.0, 0.0, 0.0) == pytest.approx(1.0, abs=0.01)
    assert_allclose(limit.minimum, np.radians(bend_deg), atol=np.radians(1.5))


@dataclass
class WrongSlope:
    """A goal whose derivative is wrong by a factor: with 2, each step goes half of the way."""

    factor: float

    def add_to(self, equations: NormalEquations, fitted: FittedMotion) -> None:
        moved = fitted.deviations()[:, :3]
        error = np.zeros((N_FRAMES, fitted.n_variables))
        error[:, :3] = moved - 1.0
        derivative = self.factor * np.tile(np.eye(fitted.n_variables), (N_FRAMES, 1, 1))
        equations.add_frames(error, derivative)


def test_a_fit_that_hardly_decreases_has_converged(start):
    assert fit_motion(start, [WrongSlope(2.0)]).has_converged


def test_a_fit_that_only_increases_has_not_converged(start):
    fit = fit_motion(start, [WrongSlope(-1.0)])

    assert not fit.has_converged
    assert_allclose(fit.motion.root_positions, start.motion.root_positions)
