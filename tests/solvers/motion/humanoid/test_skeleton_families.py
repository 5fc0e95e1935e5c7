"""Every common skeleton gets its roles; ambiguous ones get a low score."""

from collections import Counter

import numpy as np
import pytest
from rigs import FAMILIES, Joint, joints_of, skeleton_from

from solvers.motion import Skeleton, find_humanoid_map
from solvers.motion.humanoid.roles import MIN_NAME_SCORE


def expected(joints: list[Joint]) -> dict[str, str]:
    return {joint.role: joint.name for joint in joints if joint.role}


def shuffled(joints: list[Joint], seed: int) -> list[Joint]:
    """Return the joints in another order, parents first."""
    rng, waiting, done = np.random.default_rng(seed), list(joints), []
    while waiting:
        ready = [j for j in waiting if j.parent in {"", *(d.name for d in done)}]
        chosen = ready[rng.integers(len(ready))]
        waiting.remove(chosen)
        done.append(chosen)
    return done


def renamed(joints: list[Joint], rename) -> list[Joint]:
    return [
        joint._replace(
            name=rename(joint.name), parent=rename(joint.parent) if joint.parent else ""
        )
        for joint in joints
    ]


def without(joints: list[Joint], name: str) -> list[Joint]:
    parent = next(joint.parent for joint in joints if joint.name == name)
    return [
        joint._replace(parent=parent) if joint.parent == name else joint
        for joint in joints
        if joint.name != name
    ]


def test_at_least_forty_skeleton_families_are_tested():
    assert len(FAMILIES) >= 40


@pytest.mark.parametrize("family", FAMILIES)
def test_every_family_gets_its_roles(family):
    joints = joints_of(family)

    found = find_humanoid_map(skeleton_from(joints))

    assert dict(found.joints) == expected(joints)
    assert found.score > MIN_NAME_SCORE or family == "Meta avatar"


@pytest.mark.parametrize("family", FAMILIES)
def test_roles_do_not_depend_on_joint_order(family):
    joints = shuffled(joints_of(family), seed=1)

    assert dict(find_humanoid_map(skeleton_from(joints)).joints) == expected(joints)


@pytest.mark.parametrize("prefix", ["Actor1:", "Armature|", "char_", "rig:Skeleton1:"])
@pytest.mark.parametrize("family", FAMILIES)
def test_roles_do_not_depend_on_prefixes(family, prefix):
    joints = renamed(joints_of(family), lambda name: prefix + name)

    assert dict(find_humanoid_map(skeleton_from(joints)).joints) == expected(joints)


def test_numbers_after_a_sign_are_no_part_of_names():
    """As in takes of LaFAN1 that were written again: before, the neck was the head."""
    joints = joints_of("Mixamo")
    numbers = {joint.name: count for count, joint in enumerate(joints)}
    numbered = renamed(joints, lambda name: f"{name}_#{numbers[name]}")

    assert dict(find_humanoid_map(skeleton_from(numbered)).joints) == expected(numbered)


def test_the_joint_that_carries_the_legs_is_the_hips():
    """A name in no table does not leave a body with helper joints without hips."""
    joints = renamed(
        joints_of("Talking With Hands"), lambda name: {"b_root": "b_center"}.get(name, name)
    )

    assert find_humanoid_map(skeleton_from(joints)).joint("hips") == "b_center"


@pytest.mark.parametrize("family", FAMILIES)
def test_without_one_joint_no_other_role_is_wrong(family):
    joints = joints_of(family)
    root = joints[0].name
    for missing in joints:
        if missing.name == root or missing.role in {"hips", ""}:
            continue
        rest = without(joints, missing.name)

        found = find_humanoid_map(skeleton_from(rest))

        right = expected(rest)
        wrong = {
            role: name
            for role, name in found.joints.items()
            if right.get(role, name) != name or (role not in right and name in right.values())
        }
        wrong = {role: name for role, name in wrong.items() if not _is_spine(role)}
        assert not wrong or found.score < MIN_NAME_SCORE, missing.name


def _is_spine(role: str) -> bool:
    """Whether a role may fall to the next joint of the spine, where one is missing."""
    return role in {"spine", "chest", "upperChest", "neck"}


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("axes", [(0, 1, 2), (1, 2, 0), (0, 2, 1)])
def test_structure_gives_the_roles_in_any_axes(family, axes):
    """Names with a side only; the axes are permuted and one may be flipped."""
    joints = joints_of(family)
    sign = 1.0 if axes != (0, 2, 1) else -1.0
    counts, numbers = Counter(), {}
    for joint in joints:
        side = "R" if joint.position[0] < -0.01 else "L" if joint.position[0] > 0.01 else "C"
        numbers[joint.name] = f"{side}_{counts[side]}"
        counts[side] += 1
    joints = renamed(joints, lambda name: numbers[name])
    permuted = [j._replace(position=j.position[list(axes)] * (1, sign, 1)) for j in joints]

    found = find_humanoid_map(skeleton_from(permuted))

    limbs = {
        role: name for role, name in expected(joints).items() if "eg" in role or "rm" in role
    }
    assert {role: found.joints.get(role) for role in limbs} == limbs


def test_toes_are_not_classified_as_fingers():
    """Character Creator names its toes after fingers, and the legs come first."""
    joints = joints_of("Character Creator")
    foot = next(joint for joint in joints if joint.role == "leftToes")
    hand = next(joint for joint in joints if joint.role == "leftHand")
    for number in (1, 2, 3):
        toe = f"CC_Base_L_IndexToe{number}"
        finger = f"CC_Base_L_Index{number}"
        step = np.array((0.03, 0.0, 0.0)) * number
        joints.append(Joint(toe, foot.name, "", foot.position + step))
        joints.append(Joint(finger, hand.name, "", hand.position + step))
    ordered = shuffled(joints, seed=3)

    found = find_humanoid_map(skeleton_from(ordered))

    assert found.joint("leftIndexProximal") in {None, "CC_Base_L_Index1"}
    assert not any("IndexToe" in name for name in found.joints.values())


def test_search_of_many_equal_limbs_ends_within_its_budget():
    """An octopus of 585 joints is searched within its budget, and is no person."""
    parents, offsets = [-1], [np.zeros(3)]
    level = [0]
    for _ in range(3):
        above, level = level, []
        for joint in above:
            for number in range(8):
                level.append(len(parents))
                parents.append(joint)
                angle = number * np.pi / 4
                offsets.append(np.array((np.cos(angle), np.sin(angle), -0.2)))
    names = tuple(f"j{number}" for number in range(len(parents)))

    found = find_humanoid_map(Skeleton(names, tuple(parents), np.array(offsets)))

    assert found.score < MIN_NAME_SCORE
