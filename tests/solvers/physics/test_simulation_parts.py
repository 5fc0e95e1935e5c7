"""The parts of the simulation equal closed forms."""

import os
import sys
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import HumanoidMap, Motion, Skeleton, find_humanoid_map
from solvers.physics import NoPhysicsError
from solvers.physics.body import Capsule, PhysicsBody, build_physics_body
from solvers.physics.body_surface import (
    height_correction,
    joints_of_ends,
    lowest_points,
    measure_clearance,
    measure_penetration,
)
from solvers.physics.control import _project_to_cones
from solvers.physics.engine import load_engine
from solvers.physics.tables import MASS_FRACTIONS, ROLES, role_without_side
from solvers.physics.target import blend_motions, fill_motion_gaps, smooth_target
from solvers.physics.world import build_world
from solvers.rotations.representations import quaternion_from_rotation_vector, rotate
from solvers.samples import GaitSettings, walking_gait

STEP = 1.0 / 240.0
HEIGHT, RADIUS = 2.0, 0.1


@pytest.fixture(scope="module")
def engine():
    return load_engine()


def body_of(*capsules: Capsule) -> PhysicsBody:
    """A body of one joint."""
    skeleton = Skeleton(("ball",), (-1,), np.zeros((1, 3)))
    motion = Motion(skeleton, np.tile([1.0, 0, 0, 0], (1, 1, 1)), np.zeros((1, 3)), 30.0)
    return replace(build_physics_body(motion, HumanoidMap()), capsules=capsules, size=1.0)


def ball(position=(0.0, 0.0, 0.0)) -> Capsule:
    return Capsule(0, np.tile(np.array(position), (2, 1)), RADIUS, 1.0)


def test_dropped_ball_falls_freely_and_comes_to_rest(engine):
    world = build_world(engine, body_of(ball()), 0.5, 1.0, STEP)
    world.data.qpos[:3] = 0.0, 0.0, 0.5 + RADIUS + HEIGHT
    n_fall = int(np.sqrt(2 * HEIGHT / 9.81) / STEP)

    for _ in range(n_fall):
        engine.mj_step(world.model, world.data)

    assert_allclose(world.data.qvel[2], -9.81 * n_fall * STEP, rtol=1e-9)
    for _ in range(480):
        engine.mj_step(world.model, world.data)
    assert_allclose(world.data.qpos[2], 0.5 + RADIUS, atol=0.001)
    assert_allclose(world.data.qvel[2], 0.0, atol=0.001)


@pytest.mark.parametrize("friction", [0.3, 0.8])
def test_friction_stops_a_sled_after_the_coulomb_distance(engine, friction):
    runners = [ball(position) for position in ((0.5, 0.5, 0), (0.5, -0.5, 0), (-0.8, 0, 0))]
    world = build_world(engine, body_of(*runners), 0.0, friction, STEP)
    world.data.qpos[2], world.data.qvel[0] = RADIUS, 2.0

    for _ in range(960):
        engine.mj_step(world.model, world.data)

    assert_allclose(world.data.qpos[0], 2.0**2 / (2 * friction * 9.81), rtol=0.05)
    assert_allclose(world.data.qvel, 0.0, atol=0.005)


def test_energy_does_not_grow(engine, walk):
    body = build_physics_body(walk, find_humanoid_map(walk.skeleton))
    world = build_world(engine, body, 0.0, 1.0, STEP)
    world.data.qpos[2] = 2.0
    world.data.qvel[:] = np.random.default_rng(1).normal(size=world.model.nv)
    energies = []

    for _ in range(480):
        engine.mj_step(world.model, world.data)
        engine.mj_energyPos(world.model, world.data)
        engine.mj_energyVel(world.model, world.data)
        energies.append(float(world.data.energy.sum()))

    highest = np.maximum.accumulate(energies)
    assert highest[-1] <= energies[0] + 0.02 * abs(energies[0])
    assert energies[-1] < 0.7 * energies[0], "and the ground took some"


def test_mass_fractions_sum_to_one():
    assert len(ROLES) == 22
    total = sum(MASS_FRACTIONS[role_without_side(role)] for role in ROLES)
    assert_allclose(total, 1.0, atol=0.001)


@pytest.mark.parametrize(
    "missing",
    [(), ("spine", "upperChest"), ("leftToes", "rightFoot", "rightToes"), ("head", "neck")],
)
def test_mass_of_a_missing_segment_moves_to_the_one_above(walk, missing):
    humanoid = find_humanoid_map(walk.skeleton)
    for role in missing:
        humanoid = humanoid.with_joint(role, None)

    body = build_physics_body(walk, humanoid)

    assert_allclose(body.mass, 70.0 * body.size**3, rtol=0.01)
    lightest = min(capsule.mass for capsule in body.capsules)
    assert lightest > 0.0


def test_body_scales_with_the_skeleton(walk):
    humanoid, skeleton = find_humanoid_map(walk.skeleton), walk.skeleton
    tall = Skeleton(skeleton.names, skeleton.parents, 1.2 * skeleton.offsets)

    body = build_physics_body(walk, humanoid)
    taller = build_physics_body(
        Motion(tall, walk.rotations, walk.root_positions, walk.frame_rate), humanoid
    )

    assert_allclose(taller.size, 1.2 * body.size)
    assert_allclose(taller.mass, 1.2**3 * body.mass, rtol=1e-6)
    assert_allclose(
        [capsule.radius for capsule in taller.capsules],
        [1.2 * capsule.radius for capsule in body.capsules],
    )


def test_fingers_and_rigid_joints_are_no_segments():
    names = ("hips", "joint", "leftUpperLeg", "rightUpperLeg", "leftLowerLeg", "rightLowerLeg")
    offsets = [[0, 0, 1], [0.1, 0, 0], [0, 0, 0], [-0.1, 0, 0], [0, 0, -0.4], [0, 0, -0.4]]
    skeleton = Skeleton(
        (*names, "finger"), (-1, 0, 1, 0, 2, 3, 0), np.array([*offsets, [0, 0, 0.3]])
    )
    vectors = np.zeros((9, 7, 3))
    vectors[:, 1, 2] = 0.5
    vectors[:, 6, 2] = np.arange(9)
    motion = Motion(skeleton, quaternion_from_rotation_vector(vectors), np.zeros((9, 3)), 30.0)
    humanoid = HumanoidMap({name: name for name in names if name != "joint"})

    body = build_physics_body(motion, humanoid)

    assert [skeleton.names[joint] for joint in body.joints] == [
        "hips", "leftUpperLeg", "leftLowerLeg", "rightUpperLeg", "rightLowerLeg",
    ]  # fmt: skip
    frame = body.frames[2]
    assert frame.above == 0
    assert_allclose(frame.position, [0.1, 0.0, 0.0])
    assert_allclose(frame.rotation, quaternion_from_rotation_vector([0.0, 0.0, 0.5]))


def test_target_velocities_equal_finite_differences(rng):
    """Compare velocities and accelerations with differences of positions."""
    coordinates = rng.normal(size=(8, 3))
    rotations = quaternion_from_rotation_vector(rng.normal(scale=0.3, size=(8, 2, 3)))
    target = smooth_target(coordinates, rotations, 30.0, 0.05)
    n_steps = 2000
    dt = 1.0 / 30.0 / n_steps

    states = target.between(3, n_steps)

    assert_allclose(
        np.gradient(states.coordinates[:, :3], dt, axis=0)[5:-5],
        states.velocities[5:-5, :3],
        atol=1e-3,
    )
    for kind, faster in (
        (states.velocities[:, :3], states.accelerations[:, :3]),
        (states.velocities[:, 3:], states.accelerations[:, 3:]),
    ):
        assert_allclose(np.gradient(kind, dt, axis=0)[5:-5], faster[5:-5], atol=0.1)
    differences = angular_velocities(states.coordinates, dt)
    assert_allclose(differences[5:-5], states.velocities[5:-5, 3:], atol=1e-3)


def angular_velocities(coordinates, dt):
    """Angular velocity in the joint's frame, from the motion of two of its axes."""
    rotations = coordinates[:, 3:].reshape(len(coordinates), -1, 4)
    x, y = (rotate(rotations, axis) for axis in np.eye(3)[:2])
    z = np.cross(x, y)
    dx, dy, dz = (np.gradient(axis, dt, axis=0) for axis in (x, y, z))
    own = np.stack([(z * dy).sum(-1), (x * dz).sum(-1), (y * dx).sum(-1)], axis=-1)
    return own.reshape(len(coordinates), -1)


@pytest.mark.parametrize("frame_rate", [30.0, 120.0])
def test_target_smoothing_equals_a_gaussian_at_any_frame_rate(frame_rate):
    time = np.arange(int(4 * frame_rate)) / frame_rate
    wave = np.sin(2 * np.pi * 4.0 * time)
    coordinates = np.stack([wave, 0 * wave, 3.0 * time], axis=-1)
    still = np.tile([1.0, 0.0, 0.0, 0.0], (len(time), 1, 1))

    target = smooth_target(coordinates, still, frame_rate, 0.03).at_frames()

    inner = slice(len(time) // 4, -len(time) // 4)
    gain = np.exp(-0.5 * (2 * np.pi * 4.0 * 0.03) ** 2)
    assert_allclose(target[inner, 0], gain * wave[inner], atol=0.02)
    assert_allclose(target[:, 2], 3.0 * time, atol=1e-9)  # a straight path stays unchanged


def test_fill_gaps_interpolates_and_holds_the_ends():
    skeleton = Skeleton(("a", "b"), (-1, 0), np.zeros((2, 3)))
    vectors = np.zeros((7, 2, 3))
    vectors[:, 0, 2] = [9.0, 0.0, 9.0, 9.0, 0.9, 9.0, 9.0]
    rotations = quaternion_from_rotation_vector(vectors)
    coordinates = np.arange(21.0).reshape(7, 3)
    rotations[[0, 2, 3, 5, 6], 0] = np.nan
    coordinates[2] = np.nan

    filled = fill_motion_gaps(Motion(skeleton, rotations, coordinates, 30.0))

    angles = [0.0, 0.0, 0.3, 0.6, 0.9, 0.9, 0.9]
    vectors[:, 0, 2] = angles
    assert_allclose(filled.rotations, quaternion_from_rotation_vector(vectors), atol=1e-12)
    assert_allclose(filled.root_positions, np.arange(21.0).reshape(7, 3))


def test_ground_forces_stay_in_the_friction_cone():
    given = np.array([-5.0, 1.0, 1.0, 10.0, 3.0, 4.0, 10.0, 30.0, 40.0])

    inside = _project_to_cones(given, friction=0.6)

    assert_allclose(inside, [0, 0, 0, 10, 3, 4, 10, 3.6, 4.8])


def test_lowest_points_are_a_radius_below_the_ends():
    """A rod of 1 m with a skin of 10 cm, rotated about X from level to upright and back."""
    rod = Capsule(0, np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), 0.1, 1.0)
    body = body_of(rod, replace(rod, touches=False))
    vectors = np.zeros((3, 1, 3))
    vectors[:, 0, 0] = 0.0, -np.pi / 2, np.pi / 6
    motion = Motion(
        body.skeleton,
        quaternion_from_rotation_vector(vectors),
        np.tile([5.0, 0, 2.0], (3, 1)),
        30.0,
    )

    points = lowest_points(body, motion)

    assert joints_of_ends(body).tolist() == [0, 0]
    assert_allclose(points[:, 0], np.tile([5.0, 0.0, 1.9], (3, 1)), atol=1e-12)
    assert_allclose(points[:, 1], [[5, 1, 1.9], [5, 0, 0.9], [5, 0.75**0.5, 2.4]], atol=1e-12)
    assert_allclose(measure_clearance(body, motion, 0.5), [1.4, 0.4, 1.4], atol=1e-12)
    assert measure_penetration(body, motion, 1.0) == pytest.approx(0.1)


def test_height_correction_raises_sunk_bodies_and_keeps_jumps():
    heights = np.zeros(300)
    heights[:100] = -0.2
    heights[150:165] = 0.4
    heights[165:170] = -0.3

    lift = height_correction(heights, frame_rate=30.0, size=1.0)

    assert_allclose(lift[:70], 0.2 - 0.02, atol=1e-3)  # two may be pressed into the ground
    assert_allclose(lift[130:], 0.0, atol=1e-3)
    assert_allclose(height_correction(np.full(90, 0.1), 30.0, 1.0), -0.1)
    assert_allclose(height_correction(np.full(90, 2.0), 30.0, 1.0), 0.0)


def test_blend_motions_is_exact_at_weights_zero_and_one(walk):
    rotated = walk.with_poses(np.roll(walk.rotations, 5, axis=0), walk.root_positions + 1.0)
    weights = np.linspace(0.0, 1.0, walk.n_frames)

    between = blend_motions(walk, rotated, range(walk.n_joints), weights)

    assert np.array_equal(between.rotations[0], walk.rotations[0])
    assert np.array_equal(between.rotations[-1], rotated.rotations[-1])
    offsets = between.root_positions - walk.root_positions
    assert_allclose(offsets, weights[:, None] + np.zeros(3))


def test_missing_engine_raises_a_readable_error(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)

    with pytest.raises(NoPhysicsError, match="Simulate needs MuJoCo, which cannot be loaded"):
        load_engine()


@pytest.mark.parametrize("before", [None, "egl"])
def test_environment_is_restored(monkeypatch, before):
    if before is None:
        monkeypatch.delenv("MUJOCO_GL", raising=False)
    else:
        monkeypatch.setenv("MUJOCO_GL", before)

    load_engine()

    assert os.environ.get("MUJOCO_GL") == before


@pytest.fixture
def walk():
    return walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
