"""Incomplete bodies and invalid maps give finite numbers or one clear message."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from rigs import mixamo, unreal

from solvers.errors import InvalidMotionError
from solvers.motion import (
    HUMANOID_ROLES,
    HumanoidMap,
    Motion,
    Skeleton,
    find_humanoid_map,
    forward_kinematics,
)
from solvers.retargeting import RetargetSettings, RootMotion, retarget
from solvers.rotations.representations import quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait

WALK = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
LEG = ("UpperLeg", "LowerLeg", "Foot", "Toes")
MAP = find_humanoid_map(WALK.skeleton)
SOME_ROLES = [
    role for role in HUMANOID_ROLES if "Proximal" not in role and "Intermediate" not in role
]


@st.composite
def mapped_trees(draw):
    """A random tree, some bones of length 0, with random roles; hips at a random joint."""
    n_joints = draw(st.integers(1, 14))
    parents = [-1, *(draw(st.integers(0, joint - 1)) for joint in range(1, n_joints))]
    coordinate = st.floats(-0.5, 0.5).map(lambda value: round(value, 1))
    offsets = draw(
        st.lists(
            st.tuples(coordinate, coordinate, coordinate), min_size=n_joints, max_size=n_joints
        )
    )
    names = tuple(f"j{joint}" for joint in range(n_joints))
    roles = draw(st.permutations(SOME_ROLES))[: n_joints - 1]
    joints = dict(
        zip(["hips", *(role for role in roles if role != "hips")], names, strict=False)
    )
    return Skeleton(names, tuple(parents), np.array(offsets)), HumanoidMap(joints)


@settings(max_examples=60)
@given(mapped_trees(), mapped_trees(), st.sampled_from(list(RootMotion)), st.integers(0, 99))
def test_random_trees_give_finite_numbers_or_a_message(source, target, root_motion, seed):
    rng = np.random.default_rng(seed)
    skeleton, source_map = source
    rotations = quaternion_from_rotation_vector(rng.normal(0, 0.5, (7, skeleton.n_joints, 3)))
    motion = Motion(skeleton, rotations, rng.normal(0, 1, (7, 3)), 30.0)

    try:
        given_motion = retarget(
            motion, source_map, *target, settings=RetargetSettings(root_motion=root_motion)
        )
    except InvalidMotionError as error:
        assert str(error).endswith(".")
        return

    assert given_motion.skeleton is target[0] and given_motion.n_frames == 7
    assert np.isfinite(given_motion.rotations).all()
    assert np.isfinite(given_motion.root_positions).all()


@settings(max_examples=20)
@given(st.sets(st.sampled_from([role for role in MAP.joints if role != "hips"]), max_size=21))
def test_any_roles_may_be_missing(missing):
    rig = unreal()
    partial = find_humanoid_map(rig)
    for role in missing:
        partial = partial.with_joint(role, None)

    for maps in ((MAP, partial), (partial_of(MAP, missing), find_humanoid_map(rig))):
        result = retarget(WALK, maps[0], rig, maps[1])
        assert np.isfinite(result.rotations).all()
        height = forward_kinematics(result).positions[:, rig.index("pelvis"), 2]
        assert height.min() > 0.6 and height.max() < 1.4


@settings(max_examples=20)
@given(st.data())
def test_gaps_affect_only_dependent_joints(data):
    """Missing joints of the source are missing in the joints that depend on them."""
    rotations, positions = WALK.rotations.copy(), WALK.root_positions.copy()
    n_gaps = data.draw(st.integers(0, 6))
    for _ in range(n_gaps):
        joint, frame = (
            data.draw(st.integers(0, WALK.n_joints - 1)),
            data.draw(st.integers(0, 29)),
        )
        rotations[frame : frame + 5, joint] = np.nan
    if data.draw(st.booleans()):
        positions[:] = np.nan
    gappy = WALK.with_poses(rotations, positions)

    result = retarget(gappy, MAP, mixamo(), find_humanoid_map(mixamo()))

    missing = ~np.isfinite(result.rotations).all(axis=-1)
    gaps = np.isnan(rotations).any(axis=-1)
    assert missing.sum() <= 2 * gaps.sum()
    assert_allclose(np.isnan(result.root_positions), np.isnan(positions))
    for role in ("leftLowerArm", "rightFoot", "head"):
        reference, actual = (
            roles.indices(skeleton)[role]
            for roles, skeleton in (
                (MAP, WALK.skeleton), (find_humanoid_map(mixamo()), mixamo()),
            )
        )  # fmt: skip
        assert (missing[:, actual] >= gaps[:, reference]).all()


def test_single_frame_is_retargeted():
    result = retarget(WALK.slice(5, 6), MAP, unreal(), find_humanoid_map(unreal()))

    assert result.n_frames == 1 and np.isfinite(result.rotations).all()


def test_deform_bones_next_to_the_hips_are_refused():
    """The thighs of a generated Rigify rig are such bones."""
    rig = mixamo()
    parents = list(rig.parents)
    loose = rig.index("mixamorig:LeftUpLeg")
    names = ("root", *rig.names)
    parents = [-1, *(parent + 1 for parent in parents)]
    parents[loose + 1] = 0
    next_to_hips = Skeleton(names, tuple(parents), np.vstack([np.zeros((1, 3)), rig.offsets]))

    with pytest.raises(
        InvalidMotionError, match=r"LeftUpLeg \(leftUpperLeg\) is not a descendant"
    ):
        retarget(WALK, MAP, next_to_hips, find_humanoid_map(next_to_hips))


def test_swapped_sides_are_refused():
    """A mirrored Kinect has them: the feet would point backward."""
    swapped = {
        role.replace("left", "?").replace("right", "left").replace("?", "right"): name
        for role, name in MAP.joints.items()
    }

    with pytest.raises(InvalidMotionError, match="source's skeleton point backwards"):
        retarget(WALK, HumanoidMap(swapped), unreal(), find_humanoid_map(unreal()))


def partial_of(humanoid: HumanoidMap, missing: set[str]) -> HumanoidMap:
    joints = {role: name for role, name in humanoid.joints.items() if role not in missing}
    return HumanoidMap(joints)


@pytest.mark.parametrize("whose", ["source", "target"])
@pytest.mark.parametrize(
    ("swapped", "sentence"),
    [
        ([("leftUpperLeg", "leftLowerLeg")], r"\(leftLowerLeg\) is not a descendant of"),
        ([("rightLowerArm", "rightHand")], r"\(rightHand\) is not a descendant of"),
        ([("leftLowerLeg", "rightLowerLeg")], r"\(leftLowerLeg\) is not a descendant of"),
        ([("leftUpperLeg", "leftFoot")], r"is not a descendant of .* \(leftUpperLeg\)"),
        ([("hips", "head")], r"is not a descendant of .* \(hips\)"),
        (
            [("neck", "leftFoot"), ("leftFoot", "leftToes")],
            r"is not a descendant|\(neck\) is below",
        ),
        (
            [(f"left{part}", f"right{part}") for part in ("UpperArm", "LowerArm", "Hand")],
            "Left arm and left leg of the {} skeleton are on different sides",
        ),
        (
            [
                (f"left{part}", f"right{part}")
                for part in ("UpperLeg", "LowerLeg", "Foot", "Toes")
            ],
            "Left arm and left leg of the {} skeleton are on different sides",
        ),
    ],
)
def test_maps_without_a_body_are_refused(whose, swapped, sentence):
    humanoid = MAP if whose == "source" else find_humanoid_map(unreal())
    joints = dict(humanoid.joints)
    for one, other in swapped:
        joints[one], joints[other] = joints[other], joints[one]
    nonsense = HumanoidMap(joints)
    maps = (nonsense, find_humanoid_map(unreal())) if whose == "source" else (MAP, nonsense)

    with pytest.raises(InvalidMotionError, match=sentence.format(f"{whose}'s")):
        retarget(WALK, maps[0], unreal(), maps[1])


def test_a_head_below_the_hips_is_refused():
    humanoid = find_humanoid_map(unreal())
    headless = humanoid.with_joint("leftToes", None).with_joint("head", "ball_l")

    with pytest.raises(InvalidMotionError, match=r"ball_l \(head\) is below pelvis \(hips\)"):
        retarget(WALK, MAP, unreal(), headless)


def test_hips_below_the_head_in_the_tree_are_refused():
    upside_down = HumanoidMap({"hips": "head", "head": "pelvis"})

    with pytest.raises(
        InvalidMotionError, match=r"head \(hips\) is a descendant of pelvis \(head\)"
    ):
        retarget(WALK, MAP, unreal(), upside_down)


def test_arms_without_an_elbow_stay_connected():
    """A missing role does not interrupt a chain."""
    partial = find_humanoid_map(unreal()).with_joint("leftLowerArm", None)

    assert np.isfinite(retarget(WALK, MAP, unreal(), partial).rotations).all()
