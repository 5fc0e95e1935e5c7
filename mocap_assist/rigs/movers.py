"""Find bones of a rig that move others: as parents or by constraints."""

from collections.abc import Iterable, Iterator

import bpy


def movers_of(armature: bpy.types.Object, bones: Iterable[str]) -> frozenset[str]:
    """Return these bones, and all of the armature's that can move any of them."""
    found: set[str] = set()
    waiting = [name for name in bones if name in armature.pose.bones]
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting.extend(_direct_movers(armature, armature.pose.bones[name]))
    return frozenset(found)


def _direct_movers(armature: bpy.types.Object, bone: bpy.types.PoseBone) -> Iterator[str]:
    if bone.parent is not None:
        yield bone.parent.name
    for constraint in bone.constraints:
        for holder in (constraint, *getattr(constraint, "targets", ())):
            if getattr(holder, "target", None) == armature and holder.subtarget:
                yield holder.subtarget
        if getattr(constraint, "pole_target", None) == armature and constraint.pole_subtarget:
            yield constraint.pole_subtarget
