"""Loaded feet keep their position; unloaded feet stay free."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.feet import find_foot_contact, find_legs
from solvers.motion import Motion, Skeleton, find_humanoid_map, forward_kinematics
from solvers.motion.humanoid import SIDES
from solvers.physics import SimulateSettings, simulate
from solvers.physics.body import build_physics_body
from solvers.physics.body_surface import find_leg_chain, lowest_points, select_foot_ends
from solvers.physics.foot_placement import (
    MIN_SWING_CLEARANCE_M,
    STANCE_DEPTH_M,
    place_feet_on_ground,
)
from solvers.physics.foot_support import detect_target_contacts
from solvers.physics.plant_target import plant_target_feet, weigh_headings
from solvers.physics.soles_and_ground import add_soles, has_long_contact
from solvers.rotations.representations import (
    multiply,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
)
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait

MILLIMETER = 0.001
MIN_LOAD_FRACTION = 0.5
"""Fraction of the weight."""


@pytest.fixture(scope="module")
def walk():
    return walking_gait(GaitSettings(duration=3.0, frame_rate=60.0))


@pytest.fixture(scope="module")
def body(walk):
    humanoid = find_humanoid_map(walk.skeleton)
    return add_soles(build_physics_body(walk, humanoid), walk, humanoid, 0.0)


@pytest.fixture(scope="module")
def shaking(walk):
    return corrupt(walk, CorruptionSettings(jitter=0.7, root_jitter=0.004, seed=3))


@pytest.fixture(scope="module")
def by_friction(shaking):
    return simulate(shaking, settings=SimulateSettings(plant=False))


@pytest.fixture(scope="module")
def planted(shaking):
    return simulate(shaking)


def test_loaded_foot_rests_on_a_fixed_point(body, by_friction, planted):
    assert np.array_equal(planted.foot_loads, by_friction.foot_loads)
    loaded = planted.foot_loads[:-1] > MIN_LOAD_FRACTION
    assert loaded.mean() > 0.3
    slow = steps(body, by_friction.motion)[loaded] < 0.3 / 60.0

    creep, rest = (steps(body, each.motion)[loaded][slow] for each in (by_friction, planted))

    assert rest.mean() < 0.35 * creep.mean()
    assert np.percentile(rest, 95) < 0.5 * MILLIMETER


def test_planting_is_horizontal(body, by_friction, planted):
    before, after = (
        lowest_points(body, each.motion)[..., 2] for each in (by_friction, planted)
    )

    own = select_foot_ends(body, "left") | select_foot_ends(body, "right")
    assert_allclose(after[:, own], before[:, own], atol=1.5 * MILLIMETER)
    assert planted.penetration_after < by_friction.penetration_after + MILLIMETER
    shift = planted.motion.root_positions - by_friction.motion.root_positions
    assert np.abs(shift).max() < 0.01


def test_planting_stays_smooth_and_near_the_take(shaking, by_friction, planted):
    assert jerk(planted.motion) < 1.03 * jerk(by_friction.motion)
    assert planted.distance < by_friction.distance + MILLIMETER


def test_planting_keeps_bone_lengths_and_the_input(shaking, planted):
    before = shaking.rotations.copy(), shaking.root_positions.copy()

    again = simulate(shaking)

    assert np.array_equal(shaking.rotations, before[0])
    assert np.array_equal(shaking.root_positions, before[1])
    assert np.array_equal(again.motion.rotations, planted.motion.rotations)
    positions = forward_kinematics(again.motion).positions
    bones = positions[:, 1:] - positions[:, list(shaking.skeleton.parents[1:])]
    lengths = np.linalg.norm(shaking.skeleton.offsets[1:], axis=-1)
    assert_allclose(np.linalg.norm(bones, axis=-1) - lengths, 0.0, atol=1e-12)


def test_ground_carries_the_weight_in_stance(walk):
    """Newton's third law, averaged over the steps of a walk of constant height."""
    result = simulate(walk)

    carried = result.foot_loads.sum(axis=1)[30:-30].mean()
    helped = result.support.mean()
    assert abs(carried - 1.0) < 0.05 + helped


def test_hop_has_a_flight_phase(walk):
    """Half a second of standing, a hop of 0.4 s, and standing again."""
    frame = in_contact_of(walk).all(axis=1).argmax()
    n_frames, rate = 90, 60.0
    time = np.arange(n_frames) / rate - 0.6
    flight = np.where(np.abs(time) < 0.2, 0.5 * 9.81 * (0.2**2 - time**2), 0.0)
    hop = Motion(
        walk.skeleton,
        np.repeat(walk.rotations[frame : frame + 1], n_frames, axis=0),
        walk.root_positions[frame] + np.outer(flight, [0.0, 0.0, 1.0]),
        rate,
    )

    result = simulate(hop)

    assert result.followed.all()
    in_air = ~result.contacts.any(axis=1)
    assert in_air[33:39].all()
    assert result.contacts[:20].any(axis=1).mean() > 0.9
    assert result.foot_loads[33:39].max() == 0.0
    rise = np.ptp(result.motion.root_positions[:, 2])
    assert 0.4 * flight.max() < rise < 1.3 * flight.max()


def test_fast_sliding_foot_is_not_planted(walk):
    """A stiff pose that moves sideways at 2 m/s with both feet on the ground slides."""
    frame = in_contact_of(walk).all(axis=1).argmax()
    n_frames, rate = 60, 60.0
    displacement = np.outer(np.arange(n_frames) / rate * 2.0, [1.0, 0.0, 0.0])
    sliding = Motion(
        walk.skeleton,
        np.repeat(walk.rotations[frame : frame + 1], n_frames, axis=0),
        walk.root_positions[frame] + displacement,
        rate,
    )

    planted, free = (
        simulate(sliding, settings=SimulateSettings(plant=plant)).motion
        for plant in (True, False)
    )

    assert np.array_equal(planted.rotations, free.rotations)
    assert np.array_equal(planted.root_positions, free.root_positions)
    displacements = planted.root_positions[-1] - planted.root_positions[0]
    assert_allclose(displacements, displacement[-1], atol=0.1)


def test_planted_feet_do_not_move(walk, body, rng):
    """Planting without simulation: the loaded part of the sole moves by less than 0.1 mm."""
    sway = np.cumsum(rng.normal(scale=0.0008, size=(walk.n_frames, 2)), axis=0)
    angles = np.cumsum(rng.normal(scale=0.001, size=walk.n_frames))
    rotations = walk.rotations.copy()
    angles = quaternion_from_rotation_vector(angles[:, None] * (0.0, 0.0, 1.0))
    rotations[:, 0] = multiply(angles, rotations[:, 0])
    roots = walk.root_positions + np.pad(sway, ((0, 0), (0, 1)))
    swaying = walk.with_poses(rotations, roots)
    in_contact = detect_target_contacts(body, walk)
    held = in_contact[1:] & in_contact[:-1]

    result = plant_target_feet(
        body, swaying, held.astype(np.float64), weigh_headings(body, swaying), 0.0
    )

    assert loaded_steps(swaying, in_contact)[held].mean() > 0.5 * MILLIMETER
    assert np.percentile(loaded_steps(result, in_contact)[held], 99) < 0.1 * MILLIMETER
    assert (
        vertical_rotations(body, result)[held].mean()
        < 0.5 * vertical_rotations(body, swaying)[held].mean()
    )


def test_planting_changes_nothing_without_planted_feet(walk, body):
    nothing = np.zeros((walk.n_frames - 1, 2))

    result = plant_target_feet(body, walk, nothing, nothing, 0.0)

    assert result is walk


def test_feet_without_toes_reach_ahead_of_their_ankles(walk):
    names, parents = walk.skeleton.names, walk.skeleton.parents
    kept = [joint for joint, name in enumerate(names) if "Toe" not in name]
    above = tuple(kept.index(parents[joint]) if joint else -1 for joint in kept)
    skeleton = Skeleton(
        tuple(names[joint] for joint in kept), above, walk.skeleton.offsets[kept]
    )
    motion = Motion(skeleton, walk.rotations[:, kept], walk.root_positions, walk.frame_rate)
    humanoid = find_humanoid_map(skeleton)

    body = add_soles(build_physics_body(motion, humanoid), motion, humanoid, 0.0)

    ankle = forward_kinematics(motion).positions[:, [skeleton.index("LeftFoot")]]
    ends = lowest_points(body, motion)[:, select_foot_ends(body, "left")] - ankle
    assert np.linalg.norm(ends[..., :2], axis=-1).max() > 0.12 * body.size


def test_brief_contact_does_not_show_the_ground(walk):
    humanoid = find_humanoid_map(walk.skeleton)

    assert has_long_contact(walk, humanoid)
    assert not has_long_contact(walk.slice(0, 18), humanoid)


def test_target_feet_are_placed_on_the_ground(walk, body):
    low = walk.with_poses(root_positions=walk.root_positions - (0.0, 0.0, 0.02))
    in_contact = detect_target_contacts(body, walk).astype(np.float64)

    result = place_feet_on_ground(body, low, in_contact, in_contact, 0.0)

    points = lowest_points(body, result)
    inner = slice(15, -15)
    for column, side in enumerate(SIDES):
        lowest = points[:, select_foot_ends(body, side), 2].min(axis=1)[inner] / body.size
        always = moving_minimum(in_contact[inner, column]) == 1.0
        never = moving_minimum(1.0 - in_contact[inner, column]) == 1.0
        assert always.any() and never.any()
        assert_allclose(lowest[always], -STANCE_DEPTH_M, atol=MILLIMETER)
        assert lowest[never].min() > 0.5 * MIN_SWING_CLEARANCE_M


def test_planting_is_equivariant_to_heading(shaking, planted):
    rotation = quaternion_from_rotation_vector([0.0, 0.0, 1.0])
    rotations = shaking.rotations.copy()
    rotations[:, 0] = multiply(rotation, rotations[:, 0])
    c, s = np.cos(1.0), np.sin(1.0)
    about = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])

    result = simulate(shaking.with_poses(rotations, shaking.root_positions @ about))

    differences = result.motion.root_positions - planted.motion.root_positions @ about
    assert np.abs(differences).mean() < MILLIMETER


def steps(body, motion):
    """Displacement of the slowest point of each sole per frame, (n_frames - 1, 2), meters."""
    points = lowest_points(body, motion)
    displacements = np.linalg.norm(np.diff(points[..., :2], axis=0), axis=-1)
    return np.stack(
        [displacements[:, select_foot_ends(body, side)].min(axis=1) for side in SIDES], -1
    )


def loaded_steps(motion, in_contact):
    """Displacement of the point of each foot that stands, (n_frames - 1, 2), meters."""
    poses, found = forward_kinematics(motion), []
    for leg in find_legs(motion.skeleton):
        held = in_contact[:, SIDES.index(leg.side)]
        foot = find_foot_contact(motion, poses, leg, held)
        points = np.stack([point.position(poses) for point in foot.points], axis=1)
        moved = (foot.step_load[..., None] * np.diff(points[..., :2], axis=0)).sum(axis=1)
        found.append(np.linalg.norm(moved, axis=-1))
    return np.stack(found, axis=-1)


def vertical_rotations(body, motion):
    """Rotation of the feet about the vertical to the next frame, (n_frames - 1, 2)."""
    ankles = [find_leg_chain(body, side)[-1] for side in SIDES]
    rotations = forward_kinematics(motion).rotations[:, ankles]
    steps = multiply(rotations[1:], rotations[:-1] * (1, -1, -1, -1))
    return np.abs(rotation_vector_from_quaternion(steps)[..., 2])


def moving_minimum(values):
    return np.array([values[max(i - 9, 0) : i + 10].min() for i in range(len(values))])


def result_body(motion):
    return build_physics_body(motion, find_humanoid_map(motion.skeleton))


def in_contact_of(motion):
    return detect_target_contacts(result_body(motion), motion)


def jerk(motion):
    thirds = np.diff(forward_kinematics(motion).positions, 3, axis=0) * motion.frame_rate**3
    return float(np.linalg.norm(thirds, axis=-1).mean())
