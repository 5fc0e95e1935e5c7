"""Right roles are trusted, wrong ones are marked, and each has a reason."""

from dataclasses import replace

from rigs import FAMILIES, joints_of, skeleton_from

from solvers.motion import (
    HumanoidMap,
    Reason,
    Skeleton,
    describe_low_confidence,
    evidence_figures,
    explain_roles,
    find_humanoid_map,
)

MAX_FALSE_MARKS = 0.01
"""Fraction of right roles that may be marked; 0.2 % were measured."""


def explained(joints):
    skeleton = skeleton_from(joints)
    humanoid = find_humanoid_map(skeleton)
    return humanoid, explain_roles(skeleton, humanoid)


def test_right_roles_of_all_families_are_hardly_ever_marked():
    marked = n_roles = 0
    for family in FAMILIES:
        humanoid, evidence = explained(joints_of(family))
        assert evidence.keys() == humanoid.joints.keys()
        n_roles += len(evidence)
        marked += sum(each.has_low_confidence for each in evidence.values())

    assert marked <= MAX_FALSE_MARKS * n_roles


def test_each_role_has_its_reason(body):
    evidence = explain_roles(body, find_humanoid_map(body))
    assert evidence["leftLowerLeg"].text == "by name and structure"

    sides = [("R_", "L_")[name.startswith("Left")] for name in body.names]
    unnamed = replace(body, names=tuple(f"{side}{n}" for n, side in enumerate(sides)))
    evidence = explain_roles(unnamed, find_humanoid_map(unnamed))
    assert evidence["leftLowerLeg"].reason is Reason.STRUCTURE
    assert evidence["leftLowerLeg"].text == "by structure only: name unknown"


def test_a_map_that_was_edited_wrongly_is_marked_and_described(body):
    humanoid = find_humanoid_map(body).with_joint("leftLowerLeg", "LeftHand")

    evidence = explain_roles(body, humanoid)

    assert evidence["leftLowerLeg"].has_low_confidence
    sentence = describe_low_confidence(humanoid, evidence)
    assert "LeftHand as leftLowerLeg (neither name nor structure suggests it)" in sentence
    figures = evidence_figures(evidence)["leftLowerLeg"]
    assert figures["reason"] == "neither name nor structure suggests it"
    assert figures["confidence"] < 0.5


def test_a_map_of_high_confidence_needs_no_sentence(body):
    humanoid = find_humanoid_map(body)

    assert describe_low_confidence(humanoid, explain_roles(body, humanoid)) == ""


def test_a_limb_without_its_middle_is_marked(body):
    """Thigh and ankle have roles, the knee has none: a joint more may be off."""
    humanoid = find_humanoid_map(body).with_joint("leftLowerLeg", None)

    evidence = explain_roles(body, humanoid)

    for role in ("leftUpperLeg", "leftFoot"):
        assert evidence[role].text == "by name, but no bone between plays leftLowerLeg"
        assert evidence[role].has_low_confidence
    assert not evidence["rightFoot"].has_low_confidence


def test_joints_that_the_skeleton_lacks_have_no_evidence(body):
    assert explain_roles(body, HumanoidMap({"hips": "Nobody"})) == {}


def test_a_skeleton_without_a_body_has_no_evidence():
    stick = Skeleton(("a",), (-1,), [[0.0, 0.0, 0.0]])

    assert explain_roles(stick, HumanoidMap({})) == {}


def test_guessed_sides_are_marked():
    """Without names and toes, a rest pose does not show which way it faces."""
    with_toes = skeleton_from(joints_of("Mixamo"))
    below_feet = {
        joint
        for joint in range(with_toes.n_joints)
        if any(with_toes.names[each].endswith("Foot") for each in with_toes.ancestors(joint))
    }
    kept = [joint for joint in range(with_toes.n_joints) if joint not in below_feet]
    found = []
    for skeleton in (with_toes, with_toes.select(kept)):
        names = tuple(f"joint{number}" for number in range(skeleton.n_joints))
        nameless = replace(skeleton, names=names)
        found.append(explain_roles(nameless, find_humanoid_map(nameless)))

    assert not any(each.reason is Reason.SIDE_GUESSED for each in found[0].values())
    assert found[1]["leftLowerLeg"].reason is Reason.SIDE_GUESSED
    assert found[1]["leftLowerLeg"].has_low_confidence
    assert found[1]["hips"].reason is Reason.STRUCTURE
