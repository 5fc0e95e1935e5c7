"""Retarget to two rigs, and keys that are left."""

from solvers.motion import Motion, Skeleton, find_humanoid_map
from solvers.retargeting import reduce_keys, retarget
from tests.fixtures.rigs import RIGS, child

from ...retarget.retarget_measures import acted, ik_figures, world_figures
from ..takes import hdm05, walk

FAMILIES = ("Mixamo",)
"""Rigs of other proportions and rest poses, besides a child's."""
TOLERANCE_M = 0.005
"""Of the keys that are left."""


def prepare() -> dict[str, object]:
    """Choose short takes in which hands meet, touch the floor, or are high; two rigs."""
    rigs = {name: RIGS[name]() for name in FAMILIES if name in RIGS} | {"child": child()}
    motions = {
        "walk": walk("07_11").slice(0, 60),
        "deposit": hdm05("depositFloorR", 1).slice(0, 60),
        "kick": hdm05("kickLFront1Reps", 2).slice(0, 60),
    }
    return {"motions": motions, "rigs": rigs}


def measure(motions: dict[str, Motion], rigs: dict[str, Skeleton]) -> dict[str, float]:
    """Figures of the benchmark of retargeting, by take and rig; number of keys."""
    figures: dict[str, float] = {}
    for name, motion in motions.items():
        source = acted(motion, find_humanoid_map(motion.skeleton))
        for rig, target in rigs.items():
            roles = find_humanoid_map(target)
            given = retarget(motion, source.humanoid, target, roles)
            result = acted(given, roles)
            found = {**world_figures(source, result), **ik_figures(source, result)}
            for what in ("hand cm", "trunk degrees", "below floor cm", "elbow acceleration"):
                figures[f"{name}, {rig}: {what}"] = found[what] + 0.01
            for what in ("knee acceleration", "IK: foot cm", "slide cm/s"):
                figures[f"{name}, {rig}: {what}"] = found[what] + 0.01
            if name == "walk" and rig == "child":
                keys = reduce_keys(given, TOLERANCE_M)
                figures["keys"] = float(
                    sum(len(curve.frames) for curve in (*keys.rotations, keys.root))
                )
    return figures
