"""The verbs that the battery of contract tests calls, and the walks that it gives them.

To add a verb, add a line to `VERBS`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from marked_bodies import markers_on

from solvers.denoising import (
    DenoiseMethod,
    DenoiseSettings,
    FilterBases,
    clamp_to_limits,
    denoise,
    find_worst_issues,
    learn_filter_bases,
    learn_joint_limits,
    measure_quality,
    plant_feet,
)
from solvers.markers import (
    constrain_clusters,
    find_rigid_clusters,
    solve_skeleton,
    unswap_markers,
)
from solvers.motion import (
    HumanoidMap,
    JointLimits,
    JointRecording,
    Motion,
    Sensor,
    Skeleton,
    Tracks,
    detect_contacts,
    find_humanoid_map,
    forward_kinematics,
    resample,
)
from solvers.physics import simulate
from solvers.progress import Progress
from solvers.retargeting import reduce_keys, retarget
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait
from solvers.workflows import fix_take, motion_from_markers, reconstruct_recording


@dataclass(frozen=True)
class Verb:
    """How the battery calls a verb, and what of its result the laws are about."""

    call: Callable[[Motion, Progress], Any]
    recording: Callable[[Any], Motion | Tracks | None] = lambda result: None
    """What moves with the input and is the same motion at any frame rate."""
    figures: Callable[[Any], Any] = lambda result: ()
    """What stays unchanged when the input is moved and rotated."""
    complete_input: bool = False
    """It wants a motion without gaps."""
    reports: bool = True
    """It takes `progress`."""
    any_rate: bool = False
    """It returns a motion, which must be the same at any frame rate."""


VERBS = {
    "denoise": Verb(
        lambda motion, progress: denoise(motion, progress=progress),
        recording=lambda result: result.recording,
        figures=lambda result: (result.outliers, result.confidence),
        any_rate=True,
    ),
    "denoise tracks": Verb(
        lambda motion, progress: denoise(points_of(motion), progress=progress),
        recording=lambda result: result.recording,
        figures=lambda result: (result.outliers, result.confidence),
        any_rate=True,
    ),
    "denoise with bases": Verb(
        lambda motion, progress: denoise(motion, bases(), progress=progress),
        recording=lambda result: result.recording,
        figures=lambda result: (result.outliers, result.confidence),
        any_rate=True,
    ),
    "denoise as published": Verb(
        lambda motion, progress: denoise(
            motion,
            bases(),
            settings=DenoiseSettings(method=DenoiseMethod.PUBLISHED),
            progress=progress,
        ),
        recording=lambda result: result.recording,
    ),
    "learn_filter_bases": Verb(
        lambda motion, progress: learn_filter_bases([motion], progress=progress),
        figures=lambda result: (result.mean, result.values),
    ),
    "measure_quality": Verb(
        lambda motion, progress: measure_quality(motion, progress=progress),
        figures=lambda result: (result.jitter, result.spikes, result.gaps),
    ),
    "find_worst_issues": Verb(
        lambda motion, progress: find_worst_issues(motion, progress=progress),
        figures=lambda result: result,
    ),
    "learn_joint_limits": Verb(
        lambda motion, progress: learn_joint_limits([motion], progress=progress),
        figures=lambda result: (result.names, result.upper - result.lower),
    ),
    "clamp_to_limits": Verb(
        lambda motion, progress: clamp_to_limits(motion, limits()),
        recording=lambda result: result,
        reports=False,
        any_rate=True,
    ),
    "plant_feet": Verb(
        lambda motion, progress: plant_feet(motion, progress=progress),
        recording=lambda result: result.motion,
        figures=lambda result: (result.contacts, result.slide_before),
        complete_input=True,
        any_rate=True,
    ),
    "simulate": Verb(
        lambda motion, progress: simulate(motion, progress=progress),
        recording=lambda result: result.motion,
        figures=lambda result: (result.contacts, result.slide_after, result.distance),
        any_rate=True,
    ),
    "reconstruct_recording": Verb(
        lambda motion, progress: reconstruct_recording(joints_of(motion), progress=progress),
        recording=lambda result: result.motion,
        figures=lambda result: result.reconstruction.confidence,
    ),
    "retarget": Verb(
        lambda motion, progress: retarget(
            motion,
            find_humanoid_map(motion.skeleton),
            tall(),
            roles_of_tall(),
            progress=progress,
        ),
        recording=lambda result: result,
        any_rate=True,
    ),
    "reduce_keys": Verb(
        lambda motion, progress: reduce_keys(motion, 0.01, progress=progress),
        complete_input=True,
    ),
    "unswap_markers": Verb(
        lambda motion, progress: unswap_markers(marked(motion), progress=progress),
        recording=lambda result: result.tracks,
        figures=lambda result: [(swap.names, swap.frames) for swap in result.swaps],
    ),
    "rigid_clusters": Verb(
        lambda motion, progress: find_rigid_clusters(marked(motion), progress=progress),
        figures=lambda result: [(cluster.names, cluster.slack) for cluster in result],
    ),
    "keep_rigid": Verb(
        lambda motion, progress: constrain_clusters(
            marked(motion), find_rigid_clusters(marked(motion)), progress=progress
        ),
        recording=lambda result: result.tracks,
        figures=lambda result: (result.filled, result.moved),
    ),
    "solve_skeleton": Verb(
        lambda motion, progress: solve_skeleton(marked(motion), progress=progress),
        recording=lambda result: result.motion,
        figures=lambda result: (result.markers, result.motion.skeleton.names),
        any_rate=True,
    ),
    "motion_from_markers": Verb(
        lambda motion, progress: motion_from_markers(marked(motion), progress=progress),
        recording=lambda result: result.motion,
        figures=lambda result: result.solved.markers,
        any_rate=True,
    ),
    "fix_take": Verb(
        lambda motion, progress: fix_take(motion, progress=progress),
        recording=lambda result: result.recording,
        figures=lambda result: result.after.issues,
        any_rate=True,
    ),
    "resample": Verb(
        lambda motion, progress: resample(motion, 40.0),
        recording=lambda result: result,
        reports=False,
    ),
    "detect_contacts": Verb(
        lambda motion, progress: detect_contacts(motion),
        figures=lambda result: result,
        complete_input=True,
        reports=False,
    ),
}
WALK = GaitSettings(duration=2.0, frame_rate=30.0)
WRONG = CorruptionSettings(jitter=2.0, spikes=0.003, root_jitter=0.003)
MISSING_FRAMES = {"LeftForeArm": range(20, 40)}
LEG = ("UpLeg", "Leg", "Foot", "ToeBase", "ToeBase_end")
JOINTS = {"Hips", "Spine", "Spine2", "Head", "LeftArm", "LeftForeArm"} | {
    side + part for side in ("Left", "Right") for part in LEG
}
"""A small body that every verb accepts."""


LEG_MARKERS = frozenset(
    side + marker
    for side in "LR"
    for marker in ("FWT", "BWT", "THI", "KNE", "SHN", "ANK", "HEE", "TOE", "MT5")
)


@cache
def bases() -> FilterBases:
    clips = [GaitSettings(duration=4.0, frame_rate=30.0, seed=seed) for seed in (1, 2)]
    return learn_filter_bases([walk_of_few_joints(clip) for clip in clips])


@cache
def limits() -> JointLimits:
    return learn_joint_limits([walk_of_few_joints(WALK)])


@cache
def tall() -> Skeleton:
    walker = walk_of_few_joints(WALK).skeleton
    return Skeleton(walker.names, walker.parents, 1.2 * walker.offsets)


@cache
def roles_of_tall() -> HumanoidMap:
    return find_humanoid_map(tall())


def damaged(name: str) -> Motion:
    missing = {} if VERBS[name].complete_input else MISSING_FRAMES
    return corrupt(walk_of_few_joints(WALK), WRONG, missing=missing)


def clean(name: str, frame_rate: float) -> Motion:
    walk = walk_of_few_joints(GaitSettings(duration=2.0, frame_rate=frame_rate))
    gap = (
        {}
        if VERBS[name].complete_input
        else {"LeftArm": range(round(frame_rate), round(1.4 * frame_rate))}
    )
    return corrupt(walk, CorruptionSettings(jitter=0.0), missing=gap)


def walk_of_few_joints(settings: GaitSettings) -> Motion:
    walk = walking_gait(settings)
    joints = [n for n, name in enumerate(walk.skeleton.names) if name in JOINTS]
    skeleton = walk.skeleton.select(joints)
    return Motion(skeleton, walk.rotations[:, joints], walk.root_positions, walk.frame_rate)


def marked(motion: Motion) -> Tracks:
    """Markers on pelvis and legs; one of the left knee has a gap, and feet are swapped."""
    tracks = markers_on(motion, keep=LEG_MARKERS)
    positions = tracks.positions.copy()
    frames = slice(motion.n_frames // 2, motion.n_frames // 2 + motion.n_frames // 6)
    knee, left, right = (tracks.names.index(name) for name in ("LKNE", "LTOE", "RTOE"))
    positions[frames, knee] = np.nan
    positions[frames, [left, right]] = positions[frames, [right, left]]
    return tracks.with_positions(positions)


def joints_of(motion: Motion) -> JointRecording:
    """As a depth camera would have tracked it."""
    return JointRecording(points_of(motion), None, Sensor.OTHER)


def points_of(motion: Motion) -> Tracks:
    return Tracks(
        motion.skeleton.names, forward_kinematics(motion).positions, motion.frame_rate
    )
