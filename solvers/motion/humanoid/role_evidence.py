"""Say how certain each role of a humanoid map is, and why."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from ..skeletons import Skeleton
from .names import name_matches, with_fingers
from .roles import MIN_MATCH, HumanoidMap
from .structure import roles_by_structure
from .tree_agreement import role_faults

TRUNK = {"spine", "chest", "upperChest", "neck"}
"""Rigs have different numbers of joints here, which names and structure may count otherwise."""
MAX_NAMED = 3
"""Joints that a sentence names."""
MIN_HUMANNESS = 0.65
"""Humanness of the proportions, as a fraction, from which the structure may contradict names.
Chosen by hand on the rigs of `tests/data/skeleton_families.txt`: their means are 0.74 to 0.8
without a joint of trunk or foot, 0.2 to 0.54 without one of thigh, shin, arm or hand."""
MIN_CONFIDENCE = 0.5
"""Confidence, as a fraction, below which a role is marked; by definition."""


class Reason(Enum):
    """What supports the role of a joint: a text for the panel, and a confidence.

    The confidence is set by hand, below the fraction of right roles that was measured on 1,058
    variants of the rigs of `tests/data/skeleton_families.txt`: as they are, without names, with
    names of other joints, and without each joint in turn. The fraction stands beside each.
    """

    CONTROL = "control of a generated rig, by its name", 0.99  # not measured
    BOTH = "by name and structure", 0.99  # 1.000 of 13,057
    NAME = "by name; the structure is unclear here", 0.9  # 0.998 of 5,241
    TRUNK = "by name; the structure counts the spine differently", 0.9  # 1.000 of 1,514
    STRUCTURE = "by structure only: name unknown", 0.8  # 0.994 of 1,105
    TREE_DECIDES = "names disagree with the tree: structure decides", 0.7  # 0.92 of 25
    UNCLEAR = "by structure only, but the proportions are hardly human", 0.4  # 0.74 of 46
    CONTRADICTED = "by name, but the structure suggests {other}", 0.15  # 0.151 of 377
    FAULT = "by name, but {fault}", 0.4  # 0.69 of 532
    NEITHER = "neither name nor structure suggests it", 0.1  # of edited maps: not measured

    def __init__(self, text: str, confidence: float) -> None:
        """Keep text and confidence apart."""
        self.text = text
        self.confidence = confidence


@dataclass(frozen=True)
class RoleEvidence:
    """How certain it is that a joint plays a role."""

    reason: Reason
    text: str
    """The reason in words, such as "by name and structure"."""

    @property
    def confidence(self) -> float:
        """That of the reason, 0 to 1."""
        return self.reason.confidence

    @property
    def has_low_confidence(self) -> bool:
        """Whether a user should look at this role."""
        return self.confidence < MIN_CONFIDENCE


def explain_roles(skeleton: Skeleton, humanoid: HumanoidMap) -> dict[str, RoleEvidence]:
    """Return the evidence for each role of a map whose joint the skeleton has.

    The map may be edited by hand or come from a preset.
    """
    named = _roles_by_name(skeleton)
    structure, humanness = roles_by_structure(skeleton)
    joints = {r: j for r, j in humanoid.joints.items() if j in skeleton.names}
    faults = role_faults(skeleton, joints)
    return {
        role: _evidence(
            role,
            joint,
            named.get(joint, set()),
            faults.get(role, ""),
            structure,
            is_human=humanness >= MIN_HUMANNESS,
        )
        for role, joint in joints.items()
    }


def _roles_by_name(skeleton: Skeleton) -> dict[str, set[str]]:
    """Return the roles that tables of names give to each joint, those that match most."""
    matches = name_matches(skeleton.names)
    most = max(map(len, matches), default=0)
    roles: dict[str, set[str]] = {}
    for match in matches:
        if len(match) > MIN_MATCH * most:
            for role, joint in with_fingers(skeleton.names, match).items():
                roles.setdefault(joint, set()).add(role)
    return roles


def _evidence(
    role: str,
    joint: str,
    named: set[str],
    fault: str,
    structure: Mapping[str, str],
    *,
    is_human: bool,
) -> RoleEvidence:
    by_structure = structure.get(role)
    if role in named:
        if fault:
            return _because(Reason.FAULT, fault=fault)
        if by_structure == joint:
            return _because(Reason.BOTH)
        if role in TRUNK:
            return _because(Reason.TRUNK)
        if by_structure and is_human:
            return _because(Reason.CONTRADICTED, other=by_structure)
        return _because(Reason.NAME)
    if by_structure != joint:
        return _because(Reason.NEITHER)
    if not is_human:
        return _because(Reason.UNCLEAR)
    return _because(Reason.TREE_DECIDES if named else Reason.STRUCTURE)


def _because(reason: Reason, **words: str) -> RoleEvidence:
    return RoleEvidence(reason, reason.text.format(**words))


def describe_low_confidence(humanoid: HumanoidMap, evidence: Mapping[str, RoleEvidence]) -> str:
    """Return a sentence about the roles with low confidence; empty without any."""
    marked = [r for r in humanoid.joints if r in evidence and evidence[r].has_low_confidence]
    if not marked:
        return ""
    named = [f"{humanoid.joints[r]} as {r} ({evidence[r].text})" for r in marked[:MAX_NAMED]]
    more = len(marked) - len(named)
    listed = "; ".join(named) + f"; and {more} more" * (more > 0)
    return f"Bones with low confidence: {listed}."


def evidence_figures(evidence: Mapping[str, RoleEvidence]) -> dict[str, dict[str, object]]:
    """Return confidence and reason by role, ready for JSON."""
    return {
        role: {"confidence": each.confidence, "reason": each.text}
        for role, each in evidence.items()
    }
