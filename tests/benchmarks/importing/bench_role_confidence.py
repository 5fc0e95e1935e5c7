"""How often the role of a bone is right, by the reason that the panel gives for it.

    make bench-roles

Rigs are those of `tests/data`, once each as they are, with names on the wrong joints, and
without each joint in turn. The confidences were chosen on `skeleton_families.txt`; nothing was
chosen on `held_out_families.txt`, whose rigs also come with other bone lengths.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator

from exports.shifted_names import SHIFTS, reproportioned, wrong_roles
from rigs import FAMILIES, HELD_OUT, Joint, joints_of, skeleton_from

from solvers.motion import Reason, explain_roles, find_humanoid_map

from ..shared.tables import table

SEEDS = (0, 1)
"""Of other bone lengths."""


def main() -> None:
    """Print the table."""
    measured = [
        _count(v for family in families for v in _variants(joints_of(family), seeds))
        for families, seeds in ((FAMILIES, ()), (HELD_OUT, SEEDS))
    ]
    rows = {
        f"{reason.name.lower()} ({reason.confidence:g})": [
            f"{right / n:.3f} of {n:,}" if (n := sum(each[reason])) else "-"
            for each in measured
            for right in (each[reason][0],)
        ]
        for reason in Reason
    }
    print(table(["reason (confidence)", "right, rigs of the choice", "right, held out"], rows))


def _variants(joints: list[Joint], seeds: Iterable[int]) -> Iterator[list[Joint]]:
    for body in (joints, *(reproportioned(joints, seed) for seed in seeds)):
        yield body
        yield from (shift(body) for shift in SHIFTS.values())
        root = body[0].name
        yield from (_without(body, joint) for joint in body if joint.name != root)


def _without(joints: list[Joint], missing: Joint) -> list[Joint]:
    return [
        joint._replace(parent=missing.parent) if joint.parent == missing.name else joint
        for joint in joints
        if joint is not missing
    ]


def _count(variants: Iterable[list[Joint]]) -> dict[Reason, list[int]]:
    """Return the numbers of right and wrong roles by reason."""
    counts: dict[Reason, list[int]] = defaultdict(lambda: [0, 0])
    for joints in variants:
        skeleton = skeleton_from(joints)
        humanoid = find_humanoid_map(skeleton)
        wrong = wrong_roles(joints, humanoid.joints)
        for role, evidence in explain_roles(skeleton, humanoid).items():
            counts[evidence.reason][role in wrong] += 1
    return counts


if __name__ == "__main__":
    main()
