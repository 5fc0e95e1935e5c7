"""Measure the confidence of each role of a humanoid map, with reasons."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

from ..skeletons import Skeleton
from .name_conflicts import (
    MIN_HUMANNESS,
    contradicted_roles,
    matches_in_tree,
    odd_limbs,
)
from .names import with_fingers
from .roles import MIN_MATCH, HumanoidMap
from .structure import Structure, roles_by_structure
from .tables import SIDES
from .tree_agreement import missing_ends, role_faults

TRUNK = {"spine", "chest", "upperChest", "neck"}
"""Rigs have different numbers of joints here, which names and structure may count otherwise."""
HINGES = {
    f"{side}{part}"
    for side in SIDES
    for part in ("UpperLeg", "LowerLeg", "Foot", "UpperArm", "LowerArm", "Hand")
}
"""Roles whose names are contradicted by the limb as a whole, if at all."""
ODD = "the lengths of this limb do not fit the body"
MAX_NAMED = 3
"""Joints that a sentence names."""
MIN_CONFIDENCE = 0.5
"""Confidence, as a fraction, below which a role is marked; by definition."""


class Reason(Enum):
    """Evidence for the role of a joint: a text for the panel, and a confidence.

    The confidence is set by hand, at most the fraction of right roles that `make bench-roles`
    measured on rigs without a joint and with names on wrong joints; comments give that of
    the rigs it was chosen on, and of held-out ones, where a contradicted name was hardly ever
    right.
    """

    CONTROL = "control of a generated rig, by its name", 0.99  # not measured
    BOTH = "by name and structure", 0.99  # 1.000, 0.997
    NAME = "by name; the structure is unclear here", 0.8  # 1.000, 0.833
    TRUNK = "by name; the structure counts the spine differently", 0.9  # 0.999, 1.000
    STRUCTURE = "by structure only: name unknown", 0.8  # 0.963, 0.990
    TREE_DECIDES = "names disagree with the tree: structure decides", 0.7  # 0.999, 0.991
    SIDE_GUESSED = "by structure only, and the side is a guess", 0.45  # 0.5 by chance
    UNCLEAR = "by structure only, but the proportions are hardly human", 0.35  # 0.375, 0.779
    CONTRADICTED = "by name, but the structure suggests {other}", 0.03  # 1.000, 0.030
    FAULT = "by name, but {fault}", 0.4  # 0.998, 0.881
    NEITHER = "neither name nor structure suggests it", 0.1  # of edited maps: not measured

    def __init__(self, text: str, confidence: float) -> None:
        """Keep text and confidence apart."""
        self.text = text
        self.confidence = confidence


@dataclass(frozen=True)
class RoleEvidence:
    """Confidence in the role of a joint, and its evidence."""

    reason: Reason
    text: str
    """The reason in words, such as "by name and structure"."""

    @property
    def confidence(self) -> float:
        """Confidence of the reason, 0 to 1."""
        return self.reason.confidence

    @property
    def has_low_confidence(self) -> bool:
        """Whether a user should look at this role."""
        return self.confidence < MIN_CONFIDENCE


def explain_roles(skeleton: Skeleton, humanoid: HumanoidMap) -> dict[str, RoleEvidence]:
    """Return the evidence for each role of a map whose joint the skeleton has.

    The map may be edited by hand or come from a preset.
    """
    structure = roles_by_structure(skeleton)
    joints = {r: j for r, j in humanoid.joints.items() if j in skeleton.names}
    contradicted = contradicted_roles(skeleton, joints, structure)
    if structure.humanness >= MIN_HUMANNESS:
        contradicted |= joints.keys() - TRUNK - HINGES
    clues = _Clues(
        _roles_by_name(skeleton),
        structure,
        role_faults(skeleton, joints),
        missing_ends(joints) | dict.fromkeys(odd_limbs(skeleton, joints, structure), ODD),
        contradicted,
    )
    return {role: _evidence(role, joint, clues) for role, joint in joints.items()}


class _Clues(NamedTuple):
    """What is known of a body and of the roles that a map gives to its joints."""

    named: Mapping[str, Collection[str]]
    """Roles that tables of names give to a joint."""
    structure: Structure
    faults: Mapping[str, str]
    """What is wrong with a role in the tree."""
    weak_faults: Mapping[str, str]
    """What is wrong with a role unless the body is human."""
    contradicted: Collection[str]
    """Roles whose names the structure may contradict."""


def _roles_by_name(skeleton: Skeleton) -> dict[str, set[str]]:
    """Return the roles that tables of names give to each joint, those that match most."""
    matches = matches_in_tree(skeleton)
    most = max(map(len, matches), default=0)
    roles: dict[str, set[str]] = {}
    for match in matches:
        if len(match) > MIN_MATCH * most:
            for role, joint in with_fingers(skeleton.names, match).items():
                roles.setdefault(joint, set()).add(role)
    return roles


def _evidence(role: str, joint: str, clues: _Clues) -> RoleEvidence:
    by_structure = clues.structure.joints.get(role)
    if role not in clues.named.get(joint, ()):
        if by_structure != joint:
            return _evidence_for(Reason.NEITHER)
        return _evidence_for(_without_name(role, joint, clues))
    if fault := clues.faults.get(role):
        return _evidence_for(Reason.FAULT, fault=fault)
    if by_structure == joint:
        return _evidence_for(Reason.BOTH)
    weak_fault = clues.weak_faults.get(role)
    if weak_fault and clues.structure.humanness < MIN_HUMANNESS:
        return _evidence_for(Reason.FAULT, fault=weak_fault)
    if by_structure and role in clues.contradicted:
        return _evidence_for(Reason.CONTRADICTED, other=by_structure)
    return _evidence_for(Reason.TRUNK if role in TRUNK else Reason.NAME)


def _without_name(role: str, joint: str, clues: _Clues) -> Reason:
    """Return why the structure decides on a joint that no table names so."""
    if clues.structure.humanness < MIN_HUMANNESS:
        return Reason.UNCLEAR
    if clues.structure.guesses_sides and role.startswith(SIDES):
        return Reason.SIDE_GUESSED
    return Reason.TREE_DECIDES if clues.named.get(joint) else Reason.STRUCTURE


def _evidence_for(reason: Reason, **words: str) -> RoleEvidence:
    return RoleEvidence(reason, reason.text.format(**words))


def describe_low_confidence(humanoid: HumanoidMap, evidence: Mapping[str, RoleEvidence]) -> str:
    """Return sentences on roles with low confidence and on names that lengths overruled.

    Empty if there are none.
    """
    known = [role for role in humanoid.joints if role in evidence]
    marked = [
        f"{humanoid.joints[role]} as {role} ({evidence[role].text})"
        for role in known
        if evidence[role].has_low_confidence
    ]
    overruled = [
        f"{humanoid.joints[role]} as {role}"
        for role in known
        if evidence[role].reason is Reason.TREE_DECIDES
    ]
    sentences = [
        f"Bones with low confidence: {_join_clauses(marked)}." * bool(marked),
        f"Bone lengths overruled these names: {_join_clauses(overruled)}." * bool(overruled),
    ]
    return " ".join(filter(None, sentences))


def _join_clauses(clauses: Sequence[str]) -> str:
    more = len(clauses) - MAX_NAMED
    return "; ".join(clauses[:MAX_NAMED]) + f"; and {more} more" * (more > 0)


def evidence_figures(evidence: Mapping[str, RoleEvidence]) -> dict[str, dict[str, object]]:
    """Return confidence and reason by role, ready for JSON."""
    return {
        role: {"confidence": each.confidence, "reason": each.text}
        for role, each in evidence.items()
    }
