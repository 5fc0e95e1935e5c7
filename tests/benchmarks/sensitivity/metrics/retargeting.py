"""Retarget to three rigs, keys that are left, and what motion itself tunes: contacts, cuts."""

import numpy as np

from solvers.motion import (
    Motion,
    Skeleton,
    detect_contacts,
    find_humanoid_map,
    motion_from_points,
    resample,
)
from solvers.motion.skeletons import find_shot_boundaries
from solvers.retargeting import reduce_keys, retarget
from solvers.rotations.representations import angle_between
from solvers.samples import CorruptionSettings, corrupt
from tests.fixtures.rigs import RIGS, child

from ...retarget.retarget_measures import acted, ik_figures, seen_figures
from ...shared import clips
from ..takes import (
    Flags,
    angle_error,
    hdm05,
    joint_tracks,
    missed_or_false,
    variety,
    walk,
)

FAMILIES = ("Mixamo",)
"""Rigs of other proportions and rest poses, besides a child's."""
TOLERANCE_M = 0.005
"""Of the keys that are left."""


def prepare() -> dict[str, object]:
    """Choose short takes in which hands meet, touch the floor, or are high; three rigs."""
    rigs = {name: RIGS[name]() for name in FAMILIES if name in RIGS} | {"child": child()}
    motions = {
        "walk": walk("07_11"),
        "deposit": hdm05("depositFloorR", 1).slice(0, 60),
        "kick": hdm05("kickLFront1Reps", 2),
    }
    still = walk("10_04")
    joined = _joined([walk("10_04"), walk("10_04").slice(70, 138), walk("10_04").slice(10, 60)])
    return {
        "motions": motions,
        "rigs": rigs,
        "contacts": _known_contacts(),
        "joined": joined,
        "points": (joint_tracks(still), still.skeleton.parents),
        "to_resample": walk("07_11", 1),
    }


def measure(
    motions: dict[str, Motion],
    rigs: dict[str, Skeleton],
    contacts: dict[str, tuple[Motion, Flags]],
    joined: tuple[Motion, tuple[int, ...]],
    points: tuple,
    to_resample: Motion,
) -> dict[str, float]:
    """Figures of the benchmark of retargeting, summed up by take; errors of the rest."""
    figures: dict[str, float] = {}
    for name, motion in motions.items():
        source = acted(motion, find_humanoid_map(motion.skeleton))
        for rig, target in rigs.items():
            roles = find_humanoid_map(target)
            given = retarget(motion, source.humanoid, target, roles)
            result = acted(given, roles)
            found = {**seen_figures(source, result), **ik_figures(source, result)}
            for what in ("hand cm", "trunk degrees", "below floor cm", "elbow acceleration"):
                figures[f"{name}, {rig}: {what}"] = found[what] + 0.01
            for what in ("knee acceleration", "IK: foot cm", "slide cm/s"):
                figures[f"{name}, {rig}: {what}"] = found[what] + 0.01
            if name == "walk" and rig == "child":
                keys = reduce_keys(given, TOLERANCE_M)
                figures["keys"] = float(
                    sum(len(curve.frames) for curve in (*keys.rotations, keys.root))
                )
    for name, (motion, truth) in contacts.items():
        figures[f"contacts, {name}: missed or false %"] = 1.0 + missed_or_false(
            detect_contacts(motion), truth
        )
    motion, cuts = joined
    found_cuts = set(find_shot_boundaries(motion))
    figures["cuts missed or false"] = 1.0 + len(found_cuts ^ set(cuts))
    tracks, parents = points
    rebuilt = motion_from_points(tracks, parents)
    turn = angle_between(rebuilt.rotations[1:], rebuilt.rotations[:-1])
    figures["points to motion: turning deg"] = float(np.degrees(turn).mean())
    there = resample(resample(to_resample, 30.0), to_resample.frame_rate)
    n = min(there.n_frames, to_resample.n_frames)
    figures["resampled: deg"] = angle_error(there.slice(0, n), to_resample.slice(0, n))
    return figures


def _known_contacts() -> dict[str, tuple[Motion, Flags]]:
    """Contacts of takes as they are, to be found again after noise and at other rates."""
    found = {}
    for name, motion in {"walk": walk("26_01", 1), "punch": variety("02_05")}.items():
        clean = motion.slice(0, 480)
        flags = detect_contacts(clean)
        slow = clips.every(clean, clips.STEP)
        noise = CorruptionSettings(jitter=0.5, root_jitter=0.002)
        found[f"{name} 30 Hz, noise"] = corrupt(slow, noise), flags[:: clips.STEP]
        found[f"{name} 120 Hz"] = clean, flags
    return found


def _joined(parts: list[Motion]) -> tuple[Motion, tuple[int, ...]]:
    rotations = np.concatenate([part.rotations for part in parts])
    places = np.concatenate([part.root_positions for part in parts])
    cuts = tuple(int(each) for each in np.cumsum([part.n_frames for part in parts])[:-1])
    return Motion(parts[0].skeleton, rotations, places, parts[0].frame_rate), cuts
