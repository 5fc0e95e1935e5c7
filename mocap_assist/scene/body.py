"""Find the bone of an armature that carries the body."""

from collections.abc import Sequence

from ...solvers.motion import Skeleton, find_humanoid_map
from .rig import Rig

ENDS_OF_BODY = ("leftFoot", "rightFoot", "head")


def body_root(rig: Rig, travels: Sequence[bool]) -> int:
    """Return the hips: the bone that moves the complete figure.

    Candidates are the parentless bone with the most bones below it and all bones whose keyed
    location changes. Of them the deepest is taken that still carries both feet and the head:
    Unreal's pelvis rather than its root, but never the spine of a take in which every bone
    has location keys. Where no body is recognized, the lowest tip stands for the feet, and
    half of all bones have to be carried.
    """
    trees = {bone: set(rig.subtree(bone)) for bone in range(len(rig.bones))}
    tops = [bone for bone, parent in enumerate(rig.parents) if parent < 0]
    top = max(tops, key=lambda bone: len(trees[bone]))
    ends = _ends_of_body(rig, top)
    min_bones = 0
    if not ends:
        tips = [bone for bone in trees[top] if len(trees[bone]) == 1]
        ends = {min(tips, key=lambda bone: (rig.heads[bone][2], bone))}
        min_bones = len(rig.bones) // 2
    carriers = [
        bone
        for bone in sorted(trees[top])
        if travels[bone] and ends <= trees[bone] and len(trees[bone]) >= min_bones
    ]
    return max(carriers, key=lambda bone: len(rig.chain_to(bone)), default=top)


def _ends_of_body(rig: Rig, top: int) -> set[int]:
    """Return feet and head, or nothing where they are not all recognized."""
    bones = rig.subtree(top)
    index = {bone: number for number, bone in enumerate(bones)}
    parents = tuple(index.get(rig.parents[bone], -1) for bone in bones)
    offsets = rig.heads[bones] - rig.heads[[bones[max(parent, 0)] for parent in parents]]
    skeleton = Skeleton(tuple(rig.bones[bone] for bone in bones), parents, offsets)
    roles = find_humanoid_map(skeleton).indices(skeleton)
    if not all(role in roles for role in ENDS_OF_BODY):
        return set()
    return {bones[roles[role]] for role in ENDS_OF_BODY}
