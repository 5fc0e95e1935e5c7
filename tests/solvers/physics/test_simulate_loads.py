"""Ground forces on the parts of a body, and which feet stand on them."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.feet import find_foot_joints
from solvers.motion import (
    HumanoidMap,
    Motion,
    Skeleton,
    find_humanoid_map,
    forward_kinematics,
)
from solvers.motion.humanoid import UP
from solvers.physics.body import Capsule, PhysicsBody, build_physics_body
from solvers.physics.body_surface import lowest_points, select_foot_ends
from solvers.physics.contact_loads import add_loads
from solvers.physics.control import ARM_REGULARIZATION, _ground_forces
from solvers.physics.engine import load_engine
from solvers.physics.foot_support import compute_support_weights
from solvers.physics.plant_target import plant_target_feet
from solvers.physics.simulate_segment import SimulatedSegment, _plant_segment
from solvers.physics.soles_and_ground import add_soles
from solvers.physics.world import build_world
from solvers.rotations import multiply, quaternion_from_rotation_vector, rotate
from solvers.samples import GaitSettings, walking_gait

STEP = 1.0 / 240.0
RADIUS = 0.1


def test_ground_load_is_greater_at_the_heavier_end_of_a_beam():
    """A light beam with a ball over its second end: the lever arm of the first end is 0."""
    engine = load_engine()
    beam = Capsule(0, np.array([[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]]), RADIUS, 1e-6)
    keel = Capsule(0, np.array([[0.0, -0.5, 0.0], [0.0, 0.5, 0.0]]), RADIUS, 1e-6)
    weight = Capsule(0, np.tile([0.4, 0.0, 0.0], (2, 1)), RADIUS, 1.0, touches=False)
    skeleton = Skeleton(("beam",), (-1,), np.zeros((1, 3)))
    motion = Motion(skeleton, np.tile([1.0, 0, 0, 0], (1, 1, 1)), np.zeros((1, 3)), 30.0)
    body = replace(
        build_physics_body(motion, HumanoidMap()), capsules=(weight, beam, keel), size=1.0
    )
    world = build_world(engine, body, 0.0, 1.0, STEP)
    world.data.qpos[2] = RADIUS
    loads = np.zeros(4)

    for _ in range(480):
        engine.mj_step(world.model, world.data)
    add_loads(world, loads, 1.0 / 9.81)

    assert_allclose(loads.sum(), 1.0, rtol=0.01)
    assert loads[1] > 0.7
    assert loads[0] < 0.1


@pytest.mark.parametrize(("load", "least", "most"), [(0.15, 1.0, 1.0), (0.08, 0.1, 0.5)])
def test_foot_of_the_free_leg_stands_and_one_that_touches_moves(load, least, most):
    """The other leg carries the rest of the weight; the feet of the target stand nowhere."""
    body, standing = standing_body()
    ends = select_foot_ends(body, "left")
    loads = np.tile(load * ends / ends.sum(), (20, 1))

    weights = compute_support_weights(body, standing, loads, np.zeros((20, 2)))

    assert (weights[:, 0] >= least - 1e-9).all()
    assert (weights[:, 0] <= most).all()


def test_foot_without_load_stands_where_the_target_does():
    body, standing = standing_body()
    target_weights = np.tile([0.7, 0.0], (20, 1))
    loads = np.zeros((20, len(select_foot_ends(body, "left"))))

    weights = compute_support_weights(body, standing, loads, target_weights)

    assert_allclose(weights, target_weights, atol=1e-9)


def test_foot_that_swivels_about_a_corner_of_its_sole_is_held():
    """The corner rests, so no part of the sole slides where it may touch the ground."""
    body, standing = standing_body()
    swiveling = swiveled(body, standing)
    left = np.ones((standing.n_frames - 1, 2)) * [1, 0]

    result = plant_target_feet(body, swiveling, left, 0 * left, 0.0)

    assert slower_joint(result) < 0.4 * slower_joint(swiveling)


def test_foot_that_stands_turns_only_where_it_turns_in_the_take():
    body, standing = standing_body()
    swiveling = swiveled(body, standing)
    stands = np.ones((standing.n_frames, 2)) * [1, 0]
    loads = np.zeros((standing.n_frames, 2 * len(body.ground_capsules)))
    segment = SimulatedSegment(
        swiveling, stands[:, 0] > 0, stands > 0, stands[:, 0], loads, stands, 0, 0.02
    )

    held, turns = (
        _plant_segment(body, segment, take, 0.0).motion for take in (standing, swiveling)
    )

    assert slower_joint(held) < 0.1 * slower_joint(swiveling) < slower_joint(turns)


def swiveled(body: PhysicsBody, motion: Motion) -> Motion:
    """Return the motion, turned about a corner of the left sole."""
    ends = lowest_points(body, motion)[0, select_foot_ends(body, "left")]
    corner = ends[-1] * (1.0, 1.0, 0.0)
    turns = quaternion_from_rotation_vector(
        np.linspace(0.0, 0.3, motion.n_frames)[:, None] * UP
    )
    rotations = motion.rotations.copy()
    rotations[:, 0] = multiply(turns, rotations[:, 0])
    return motion.with_poses(rotations, corner + rotate(turns, motion.root_positions - corner))


def slower_joint(motion: Motion) -> float:
    """Return the mean step of the slower of ankle and toes of the left foot, meters."""
    feet = find_foot_joints(motion.skeleton)
    steps = np.diff(forward_kinematics(motion).positions[:, feet[0], :2], axis=0)
    return float(np.linalg.norm(steps, axis=-1).min(axis=-1).mean())


def standing_body() -> tuple[PhysicsBody, Motion]:
    """Return a body, and a third of a second in which it does not move."""
    walk = walking_gait(GaitSettings(duration=1.0, frame_rate=60.0))
    humanoid = find_humanoid_map(walk.skeleton)
    body = add_soles(build_physics_body(walk, humanoid), walk, humanoid, 0.0)
    rotations, roots = (
        np.repeat(each[:1], 20, axis=0) for each in (walk.rotations, walk.root_positions)
    )
    return body, Motion(walk.skeleton, rotations, roots, 60.0)


def test_legs_carry_the_body_where_arms_touch_too():
    """A foot and a hand at the same point: the hand would carry half of the weight."""
    at_the_point = np.zeros((3, 6))
    at_the_point[[0, 1, 2], [2, 0, 1]] = 1.0
    weight = np.array([0.0, 0.0, 700.0, 0.0, 0.0, 0.0])
    penalties = np.repeat([1.0, ARM_REGULARIZATION], 3)

    forces = _ground_forces(
        np.vstack([at_the_point] * 2),
        penalties,
        weight,
        SimpleNamespace(size=1.0, friction=0.8),
    )

    foot, hand = forces[0], forces[3]
    assert_allclose(foot + hand, 700.0, rtol=0.01)
    assert hand < 0.1 * foot


def test_arms_and_head_are_weak():
    walk = walking_gait(GaitSettings(duration=0.2))
    humanoid = find_humanoid_map(walk.skeleton)
    body = build_physics_body(walk, humanoid)
    world = build_world(load_engine(), body, 0.0, 1.0, STEP)
    weak = {
        body.roles.get(joint)
        for joint, number in zip(body.joints, world.bodies, strict=True)
        if world.weak[world.model.geom_bodyid == number].any()
    }
    assert {"head", "leftLowerArm", "rightLowerArm", "leftHand", "rightHand"} <= weak
    assert not {"hips", "leftFoot", "rightFoot", "leftLowerLeg", "rightLowerLeg"} & weak
