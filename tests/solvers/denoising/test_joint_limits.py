"""Limits clamp any excess softly and change nothing else."""

from dataclasses import astuple

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising.limits.clamp_to_limits import clamp_to_limits, limit_excess
from solvers.denoising.limits.learn_limits import JointLimitsSettings, learn_joint_limits
from solvers.errors import InvalidMotionError, InvalidSettingError
from solvers.motion import JointLimits, Motion, Skeleton, find_humanoid_map
from solvers.motion.humanoid.canonical import canonical_rotations, from_canonical
from solvers.rotations.representations import (
    IDENTITY,
    angle_between,
    inverse,
    multiply,
    quaternion_from_euler,
    quaternion_from_rotation_vector,
    rotate,
)
from solvers.samples import GaitSettings, walking_gait

INF = np.inf


def motion_of_joint(skeleton: Skeleton, joint: int, rotations: np.ndarray) -> Motion:
    """Return a motion in which one joint rotates and the others rest."""
    all_rotations = np.tile(IDENTITY, (len(rotations), skeleton.n_joints, 1))
    all_rotations[:, joint] = rotations
    return Motion(skeleton, all_rotations, np.zeros((len(rotations), 3)), 30.0)


def euler_limits(name: str, axes, lower, upper, order: str = "ZYX") -> JointLimits:
    """Return limits like those of a Blender constraint: about the bone's own rest axes."""
    return JointLimits((name,), np.array([False]), axes, axes, (order,), lower, upper)


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=3.0, frame_rate=30.0))


@pytest.fixture
def bone_axes(rng):
    return quaternion_from_rotation_vector(rng.normal(size=3))


def about_bone_x(axes, degrees) -> np.ndarray:
    """Return local rotations about the bone's own x axis."""
    angles = np.radians(np.asarray(degrees, dtype=float))
    return quaternion_from_rotation_vector(angles[:, None] * rotate(axes, [1.0, 0.0, 0.0]))


def test_rotation_beyond_a_limit_stops_at_the_limit(leg, bone_axes):
    motion = motion_of_joint(leg, 1, about_bone_x(bone_axes, [-20.0, 30.0, 60.0]))
    limits = euler_limits("knee", bone_axes, [0, 0, 0], np.radians([0, 0, 45]))

    clamped = clamp_to_limits(motion, limits, softness=0.0)

    assert_allclose(
        angle_between(clamped.rotations[:, 1], about_bone_x(bone_axes, [0.0, 30.0, 45.0])),
        0,
        atol=1e-7,
    )


def test_soft_limit_starts_with_slope_one_and_is_bounded_by_its_softness(leg):
    degrees = np.arange(40.0, 150.0, 0.5)
    motion = motion_of_joint(leg, 1, about_bone_x(IDENTITY, degrees))
    limits = euler_limits("knee", IDENTITY, [-INF, -INF, 0], [INF, INF, np.radians(45)])

    clamped = clamp_to_limits(motion, limits, softness=np.radians(10.0))

    angles = np.degrees(angle_between(clamped.rotations[:, 1], IDENTITY))
    slopes = np.diff(angles) / 0.5
    assert (clamped.rotations[degrees <= 45.0] == motion.rotations[degrees <= 45.0]).all()
    assert angles.max() < 55.0
    assert (slopes > -1e-9).all() and np.abs(np.diff(slopes)).max() < 0.06


def test_rotations_within_limits_are_unchanged_bit_for_bit(walk):
    limits = euler_limits("LeftLeg", IDENTITY, [-INF] * 3, np.radians([5.0, 180.0, 180.0]))

    clamped = clamp_to_limits(walk, limits)

    changed = np.flatnonzero((clamped.rotations != walk.rotations).any(axis=(0, 2)))
    assert set(changed) <= {walk.skeleton.index("LeftLeg")}
    inside = limit_excess(walk, limits)[:, walk.skeleton.index("LeftLeg")] == 0.0
    assert (clamped.rotations[inside] == walk.rotations[inside]).all()
    assert (clamped.root_positions == walk.root_positions).all()


def test_limits_may_exceed_half_a_turn(leg):
    """150 to 210 degrees: 200 is within, though its Euler angle is -160."""
    motion = motion_of_joint(leg, 1, about_bone_x(IDENTITY, [200.0, 230.0]))
    limits = euler_limits(
        "knee", IDENTITY, np.radians([-30, -30, 150]), np.radians([30, 30, 210])
    )

    excess = limit_excess(motion, limits)[:, 1]

    assert_allclose(np.degrees(excess), [0.0, 20.0], atol=1e-6)


def test_middle_angle_may_exceed_a_right_angle(leg):
    """120 degrees about y alone, whose Euler angles may also be (180, 60, 180)."""
    motion = motion_of_joint(
        leg, 1, quaternion_from_euler(np.radians([[0.0, 120.0, 0.0]]), "ZYX")
    )
    limits = euler_limits("knee", IDENTITY, np.radians([-5, 0, -5]), np.radians([5, 130, 5]))

    assert limit_excess(motion, limits).max() < 1e-9


@pytest.mark.parametrize("order", ["XYZ", "ZXY", "YZX"])
def test_angles_are_limited_in_their_euler_order(leg, order):
    angles = np.radians([[10.0, 20.0, 30.0]])
    motion = motion_of_joint(leg, 1, quaternion_from_euler(angles, order))
    limits = euler_limits("knee", IDENTITY, [-INF] * 3, np.radians([15, 15, 40]), order)

    clamped = clamp_to_limits(motion, limits, softness=0.0)

    expected = quaternion_from_euler(np.radians([[10.0, 15.0, 30.0]]), order)
    assert_allclose(angle_between(clamped.rotations[:, 1], expected), 0.0, atol=1e-7)


def test_gaps_stay_gaps(walk):
    rotations = walk.rotations.copy()
    rotations[5:9, 3] = np.nan
    gapped = walk.with_poses(rotations)
    limits = learn_joint_limits([walk])

    assert np.isnan(clamp_to_limits(gapped, limits).rotations[5:9, 3]).all()
    assert np.isfinite(limit_excess(gapped, limits)).all()


def test_learned_limits_contain_their_examples_but_no_knee_bent_forwards(walk):
    limits = learn_joint_limits([walk])
    knee = walk.skeleton.index("LeftLeg")
    forwards = walk.rotations.copy()
    forwards[:, knee] = inverse(forwards[:, knee])

    assert limit_excess(walk, limits).max() == 0.0
    assert np.degrees(limit_excess(walk.with_poses(forwards), limits)[:, knee].max()) > 20.0


def test_learned_limits_of_a_hinge_have_one_axis(walk):
    settings = JointLimitsSettings(margin=0.0, stretch=0.0)

    limits = learn_joint_limits([walk], settings=settings)

    index = limits.names.index("leftLowerLeg")
    widths = np.degrees(limits.upper - limits.lower)[index]
    assert limits.by_role[index]
    assert widths[0] > 30.0 and widths[1:].max() < 1.0


def test_limits_learned_on_one_rig_apply_to_another(walk):
    """The other rig has lowered arms at rest and other joint names."""
    lowered, names = with_other_rest_pose(walk)
    limits = learn_joint_limits([walk])
    reverse_limits = learn_joint_limits([lowered])

    assert limit_excess(lowered, limits).max() < 1e-6
    assert limit_excess(walk, reverse_limits).max() < 1e-6
    assert set(names).isdisjoint(walk.skeleton.names)
    first_rig = limit_excess(with_elbow_bent_back(walk, "LeftForeArm"), limits)
    other_rig = limit_excess(with_elbow_bent_back(lowered, "lowerarm_l"), limits)
    assert first_rig.max() > 0.5
    assert_allclose(other_rig, first_rig, atol=1e-6)


def test_limits_of_roles_apply_next_to_those_of_other_joints(walk):
    learned = learn_joint_limits([walk])
    of_a_prop = euler_limits("prop", IDENTITY, [0.0, 0.0, 0.0], [0.0, 0.0, 0.0])
    both = JointLimits(*(
        one + other if isinstance(one, tuple) else np.concatenate([one, other])
        for one, other in zip(astuple(learned), astuple(of_a_prop), strict=True)
    ))  # fmt: skip
    bent = with_elbow_bent_back(walk, "LeftForeArm")

    assert learned.by_role.any() and not both.by_role.all()
    assert_allclose(limit_excess(bent, both), limit_excess(bent, learned))


def with_other_rest_pose(motion: Motion) -> tuple[Motion, list[str]]:
    """Return the same poses on a rig whose rest pose has its arms lowered by 50 degrees."""
    skeleton = motion.skeleton
    offsets = skeleton.offsets.copy()
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        lower = quaternion_from_rotation_vector([0.0, sign * np.radians(50.0), 0.0])
        for joint in skeleton.subtree(skeleton.index(f"{side}Arm"))[1:]:
            offsets[joint] = rotate(lower, offsets[joint])
    names = [unreal_name(name) for name in skeleton.names]
    other = Skeleton(tuple(names), skeleton.parents, offsets)
    canonical = canonical_rotations(motion, find_humanoid_map(skeleton))
    rotations = from_canonical(canonical, other, find_humanoid_map(other))
    return Motion(other, rotations, motion.root_positions, motion.frame_rate), names


def unreal_name(name: str) -> str:
    table = {
        "Hips": "pelvis", "Spine": "spine_01", "Spine1": "spine_02", "Spine2": "spine_03",
        "Neck": "neck_01", "Head": "head", "Shoulder": "clavicle", "Arm": "upperarm",
        "ForeArm": "lowerarm", "Hand": "hand", "UpLeg": "thigh", "Leg": "calf",
        "Foot": "foot", "ToeBase": "ball",
    }  # fmt: skip
    end = "_end" if name.endswith("_end") else ""
    for side, suffix in (("Left", "_l"), ("Right", "_r")):
        if name.startswith(side):
            return table[name.removesuffix("_end").removeprefix(side)] + suffix + end
    return table[name.removesuffix("_end")] + end


def with_elbow_bent_back(motion: Motion, name: str) -> Motion:
    joint = motion.skeleton.index(name)
    humanoid = find_humanoid_map(motion.skeleton)
    canonical = canonical_rotations(motion, humanoid)
    canonical[:, joint] = multiply(
        canonical[:, joint], quaternion_from_rotation_vector([0.0, 0.0, 2.5])
    )
    return motion.with_poses(from_canonical(canonical, motion.skeleton, humanoid))


def test_clamped_motions_are_within_their_limits(walk, rng):
    limits = learn_joint_limits([walk])
    noise = quaternion_from_rotation_vector(rng.normal(scale=0.5, size=(90, walk.n_joints, 3)))
    noisy = walk.with_poses(multiply(walk.rotations, noise))

    clamped = clamp_to_limits(noisy, limits, softness=np.radians(3.0))

    assert np.degrees(limit_excess(noisy, limits).max()) > 20.0
    assert np.degrees(limit_excess(clamped, limits).max()) < 3.0 + 1e-9


def test_an_empty_range_is_refused_by_name():
    with pytest.raises(InvalidMotionError, match="must not exceed the upper one: knee"):
        euler_limits("knee", IDENTITY, [1, 0, 0], [0, 0, 0])


def test_an_unknown_order_is_refused():
    with pytest.raises(InvalidMotionError, match="no such Euler orders: XYX"):
        euler_limits("knee", IDENTITY, [0, 0, 0], [0, 0, 0], "XYX")


def test_negative_softness_is_refused(walk):
    with pytest.raises(InvalidSettingError, match="softness is -1 rad"):
        clamp_to_limits(walk, learn_joint_limits([walk]), softness=-1.0)


def test_no_examples_are_refused():
    with pytest.raises(InvalidMotionError, match="at least one example"):
        learn_joint_limits([])
