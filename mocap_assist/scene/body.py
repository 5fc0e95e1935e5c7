"""Which of an armature's bones carries the body."""

from collections.abc import Sequence

from .rig import Rig


def body_root(rig: Rig, travels: Sequence[bool]) -> int:
    """Return the hips: the bone that moves the complete figure.

    Candidates are the parentless bone with the most bones below it and all bones whose keyed
    location changes. Of them the deepest is taken that still carries at least half of all
    bones and the lowest tip, which is a foot: Unreal's pelvis rather than its root, but never
    the spine of a take in which every bone was tracked in six degrees of freedom.
    """
    trees = {bone: set(rig.subtree(bone)) for bone in range(len(rig.bones))}
    tops = [bone for bone, parent in enumerate(rig.parents) if parent < 0]
    top = max(tops, key=lambda bone: len(trees[bone]))
    tips = [bone for bone in trees[top] if len(trees[bone]) == 1]
    foot = min(tips, key=lambda bone: (rig.heads[bone][2], bone))
    carriers = [
        bone
        for bone in sorted(trees[top])
        if travels[bone] and foot in trees[bone] and 2 * len(trees[bone]) >= len(rig.bones)
    ]
    return max(carriers, key=lambda bone: len(rig.chain_to(bone)), default=top)
