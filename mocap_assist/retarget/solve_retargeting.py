"""Solve of the button Retarget: motions of the target's controls."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from ...solvers.errors import InvalidMotionError
from ...solvers.motion import HumanoidMap, Motion, Skeleton, forward_kinematics
from ...solvers.motion.humanoid import normalize_postures, postures_from_motion
from ...solvers.progress import Progress, Remark, collect_remarks, unwatched, within
from ...solvers.retargeting import RetargetSettings, RootMotion, ground_path, retarget
from ...solvers.rotations import IDENTITY, inverse, multiply, rotate
from ..scene.controls import BoneKeys, Carried, TargetRig, keys_of


class Start(NamedTuple):
    """Initial position and heading of the body on the target's stage."""

    position: Array
    """On the ground, shape (2,), meters."""
    heading: float
    """Radians about the vertical; 0 is -Y."""


@dataclass(frozen=True, eq=False)
class StagedMotion:
    """A motion in the world, and the stage that it is played on."""

    motion: Motion
    origin: Array
    """Position of the source's armature on the ground, shape (3,), meters."""
    rotation: Array
    """Its rotation about the vertical, shape (4,)."""
    start: Start | None = None
    """None starts the target where the source starts."""

    def on_stage(self) -> Motion:
        """Return the motion with the armature in the middle, facing as it was built."""
        back, skeleton = inverse(self.rotation), self.motion.skeleton
        offsets = skeleton.offsets - (np.arange(skeleton.n_joints) == 0)[:, None] * self.origin
        return Motion(
            Skeleton(skeleton.names, skeleton.parents, rotate(back, offsets)),
            multiply(multiply(back, self.motion.rotations), self.rotation),
            rotate(back, self.motion.root_positions - self.origin),
            self.motion.frame_rate,
        )


@dataclass(frozen=True, eq=False)
class RetargetProblem:
    """All that Retarget depends on."""

    clips: tuple[StagedMotion, ...]
    roles: HumanoidMap
    """Of the source's joints."""
    target: TargetRig
    settings: RetargetSettings


Retargeted = tuple[Mapping[str, BoneKeys], ...]
"""For each clip, the channels of each keyed bone."""


class ReportedRetargeting(NamedTuple):
    """Retargeted clips, and what the report says about them."""

    clips: Retargeted
    remarks: tuple[Remark, ...]


def retarget_and_report(
    problem: RetargetProblem, *, progress: Progress = unwatched
) -> ReportedRetargeting:
    """Retarget each clip to the target, and collect the solver's remarks."""
    remarks: list[Remark] = []
    clips = retarget_clips(problem, progress=collect_remarks(progress, remarks))
    return ReportedRetargeting(clips, tuple(remarks))


def retarget_clips(problem: RetargetProblem, *, progress: Progress = unwatched) -> Retargeted:
    """Retarget each clip to the target, one after the other."""
    retargeted, n_clips = [], len(problem.clips)
    for index, clip in enumerate(problem.clips):
        clip_progress = within(progress, index / n_clips, (index + 1) / n_clips)
        retargeted.append(_retarget(clip, problem, clip_progress))
    return tuple(retargeted)


def _retarget(
    clip: StagedMotion, problem: RetargetProblem, progress: Progress
) -> Mapping[str, BoneKeys]:
    target, settings = problem.target, problem.settings
    on_root = settings.root_motion is RootMotion.ROOT_BONE
    if on_root and all(control.joint >= 0 for control in target.controls):
        raise InvalidMotionError(
            "The target has no bone above the hips that could carry the travel. Keep it on the"
            " hips, or add a root bone."
        )
    kept = RootMotion.KEEP if on_root else settings.root_motion
    result = retarget(
        clip.on_stage(),
        problem.roles,
        target.skeleton,
        target.humanoid,
        settings=replace(settings, root_motion=kept),
        progress=within(progress, 0.0, 0.8),
    )
    progress(0.8, "Moving controls")
    if clip.start is not None:
        result = _moved_to_start(result, target.humanoid, clip.start)
    gaps = ~np.isfinite(result.rotations).all(axis=-1)
    gaps[:, 0] |= ~np.isfinite(result.root_positions).all(axis=-1)
    completed = result.with_poses(
        _hold_last_value(result.rotations),
        _hold_last_value(result.root_positions[:, None])[:, 0],
    )
    poses = forward_kinematics(completed)
    keys = keys_of(target, poses, _travel(completed, target, settings))
    return {
        control.bone: _with_gaps(keys[control.bone], gaps[:, max(control.joint, 0)])
        for control in target.controls
    }


def _moved_to_start(motion: Motion, roles: HumanoidMap, start: Start) -> Motion:
    """Return the motion, moved and turned as a whole so that it begins at `start`."""
    body = normalize_postures(postures_from_motion(motion, roles), motion.frame_rate)
    half = 0.5 * (start.heading - body.headings[0])
    yaw = np.array([np.cos(half), 0.0, 0.0, np.sin(half)])
    first = body.hip_positions[0] * (1.0, 1.0, 0.0)
    rotations = np.array(motion.rotations)
    rotations[:, 0] = multiply(yaw, rotations[:, 0])
    root_positions = rotate(yaw, motion.root_positions - first) + np.append(start.position, 0.0)
    return motion.with_poses(rotations, root_positions)


def _travel(motion: Motion, target: TargetRig, settings: RetargetSettings) -> Carried:
    """Return the motion of the bone on the ground that carries the body."""
    path = ground_path(
        motion, target.humanoid, settings.travel_smoothing, follow_heading=settings.turn_root
    )
    hips = target.humanoid.indices(target.skeleton)["hips"]
    rest = target.skeleton.rest_positions[hips] * (1.0, 1.0, 0.0)
    return Carried(path.rotations, rest, path.positions)


def _hold_last_value(values: Array) -> Array:
    """Return values, shape (n_frames, n, k), with gaps filled by the last observed value."""
    values = values.copy()
    for column in np.flatnonzero(~np.isfinite(values).all(axis=(0, 2))):
        known = np.isfinite(values[:, column]).all(axis=-1)
        default = IDENTITY if values.shape[2] == len(IDENTITY) else np.zeros(values.shape[2])
        if not known.any():
            values[:, column] = default
            continue
        frames = np.where(known, np.arange(len(known)), known.argmax())
        values[:, column] = values[np.maximum.accumulate(frames), column]
    return values


def _with_gaps(keys: BoneKeys, gaps: NDArray[np.bool_]) -> BoneKeys:
    if not gaps.any():
        return keys
    channels = (keys.rotations, keys.locations)
    return BoneKeys(
        *(None if each is None else np.where(gaps[:, None], np.nan, each) for each in channels)
    )
