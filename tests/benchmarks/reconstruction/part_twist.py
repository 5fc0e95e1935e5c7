"""Axial rotation errors of upper arms and thighs, from positions of joints alone.

Actor dg of HDM05, who is in no shipped library; and actors of CMU, each with the library made
again without him. Settings were chosen on others: bd and bk of HDM05, and the actors of CMU in
`clips.DEV_SUBJECTS`.
"""

from collections.abc import Callable
from functools import cache

import numpy as np

from solvers.arrays import Array
from solvers.motion import Motion, forward_kinematics
from solvers.reconstruction import (
    PostureLibrary,
    Reconstruction,
    build_posture_library,
    load_posture_library,
    reconstruct,
)
from solvers.reconstruction.joint_rotations.motion_from_positions import motion_from_positions
from solvers.reconstruction.joint_rotations.trunk_twist import TWISTED_LIMBS, LimbTwists
from solvers.reconstruction.pose_library.posture_library import merge_posture_libraries
from solvers.rotations.representations import angle_between, rotate

from ..shared import clips
from ..shared.tables import number, table
from .posture_sources import cmu_library, exercise
from .twist_cases import KINECT, LIMB_MISSING, TRUE, Case, cases

Group = tuple[list[Motion], PostureLibrary]
"""Clips of one rig, and the library that they are rebuilt with."""

STRAIGHT = np.radians(15.0)
"""Bends below this are those of straight limbs."""
MAX_FRAMES = 300
"""Frames of a clip that are looked at."""
ACTOR, OTHER_ACTORS = "dg", ("bd", "bk")
SUBJECTS = ("05", "06", "13", "29", "35", "49")
UPPER = ("ShoulderLeft", "ShoulderRight", "HipLeft", "HipRight")
ARMS, LEGS = slice(0, 2), slice(2, 4)
INPUTS = (TRUE, KINECT, LIMB_MISSING)
COLUMNS = (
    "straight arms", "bent arms", "straight legs", "bent legs", "all", "elbow or knee aside",
)  # fmt: skip


def untwisted(result: Reconstruction) -> LimbTwists:
    """No twist against the trunk at all."""
    return LimbTwists(
        np.zeros((result.tracks.n_frames, len(TWISTED_LIMBS)), complex), ignore_flexion=True
    )


def neighbors(result: Reconstruction) -> LimbTwists:
    """As [SHJT13]: the neighbors' mean alone."""
    assert result.twists is not None
    return LimbTwists(result.twists.vectors, ignore_flexion=True)


METHODS: dict[str, Callable[[Reconstruction], LimbTwists | None]] = {
    "no twist": untwisted,
    "flexion alone": lambda result: None,
    "mean of neighbors, as [SHJT13]": neighbors,
    "flexion and neighbors (ours)": lambda result: result.twists,
}


def twist(n_repetitions: int) -> list[str]:
    """Return one table for each set of clips."""
    few = max(n_repetitions // 2, 1)
    actor = _hdm05(ACTOR, few)
    shipped = load_posture_library()
    subjects = [(_cmu(each, few), cmu_library(without=each)) for each in SUBJECTS]
    return [
        _table("HDM05, actor dg, with the library that ships", [(actor, shipped)]),
        _table(
            "HDM05, actor dg, with that and the same movements by actors bd and bk",
            [(actor, merge_posture_libraries(_same_movements(), shipped))],
        ),
        _table("CMU, six actors, each left out of CMU's library", subjects),
    ]


def _hdm05(actor: str, n_clips: int) -> list[Motion]:
    found = []
    for name in clips.hdm05_classes():
        own = [one for take, one in clips.hdm05(name).items() if take.startswith(actor)]
        found += own[:n_clips]
    return [_short(motion) for motion in found]


@cache
def _same_movements() -> PostureLibrary:
    motions = [motion for actor in OTHER_ACTORS for motion in _hdm05(actor, 100)]
    return build_posture_library(motions)


def _cmu(subject: str, n_clips: int) -> list[Motion]:
    if subject == "13":
        found = [clips.every(exercise(name), clips.STEP) for name in ("13_29", "13_30")]
    else:
        every = {**clips.walks(), **clips.hops()}
        found = [motion for name, motion in every.items() if name.startswith(subject)]
    return [_short(motion) for motion in found[:n_clips]]


def _short(motion: Motion) -> Motion:
    return motion.slice(0, min(motion.n_frames, MAX_FRAMES))


def _table(title: str, groups: list[Group]) -> str:
    rows = {}
    for source in INPUTS:
        found: dict[str, list[tuple[Array, Array, Case]]] = {name: [] for name in METHODS}
        for motions, library in groups:
            for case in cases(motions, source):
                result = reconstruct(case.recording, library)
                for name, method in METHODS.items():
                    found[name].append((*_errors(case, result, method(result)), case))
        for name, errors in found.items():
            rows[f"{source}: {name}"] = _cells(errors)
    n_clips = sum(len(motions) for motions, _ in groups)
    head = f"**{title}**, {n_clips} clips, degrees\n\n"
    return head + table(["joints, twist by", *COLUMNS], rows) + "\n"


def _errors(
    case: Case, result: Reconstruction, twists: LimbTwists | None
) -> tuple[Array, Array]:
    """Return axial rotation errors of limbs, and angles of flexion off the hinge axis, degrees.

    Both of shape (n_frames, 4).
    """
    motion = motion_from_positions(
        result.tracks, case.recording.parents, result.reliability.combined, twists=twists
    )
    world = forward_kinematics(motion)
    uppers = [motion.skeleton.index(name) for name in UPPER]
    off = angle_between(world.rotations[:, uppers], case.truth.rotations)
    aside = np.empty_like(off)
    for index, (name, limb) in enumerate(zip(UPPER, TWISTED_LIMBS, strict=True)):
        lower = motion.skeleton.index(_below(name))
        end = motion.skeleton.index(_below(_below(name)))
        direction = world.positions[:, end] - world.positions[:, lower]
        hinge = rotate(world.rotations[:, uppers[index]], limb.hinge)
        sine = np.einsum("fi,fi->f", direction, hinge) / np.linalg.norm(direction, axis=-1)
        aside[:, index] = np.arcsin(np.clip(np.abs(sine), 0.0, 1.0))
    return np.degrees(off), np.degrees(aside)


def _below(name: str) -> str:
    """Return the joint below one of a Kinect's limbs."""
    for above, below in (
        ("Shoulder", "Elbow"), ("Elbow", "Wrist"), ("Hip", "Knee"), ("Knee", "Ankle"),
    ):  # fmt: skip
        if name.startswith(above):
            return name.replace(above, below)
    raise KeyError(name)


def _cells(found: list[tuple[Array, Array, Case]]) -> list[str]:
    off, aside = (np.concatenate([each[part] for each in found]) for part in (0, 1))
    straight = np.concatenate([case.truth.bends for *_, case in found]) < STRAIGHT
    scored = np.concatenate([case.scored for *_, case in found])
    cells = []
    for limbs in (ARMS, LEGS):
        for part in (straight, ~straight):
            where = (part & scored)[:, limbs]
            cells.append(_mean(off[:, limbs][where]))
    return [*cells, _mean(off[scored]), _mean(aside[scored & ~straight])]


def _mean(values: Array) -> str:
    return number(float(values.mean())) if values.size else "-"
