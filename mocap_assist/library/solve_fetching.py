"""Solve of the buttons that load a clip: read it again, and retarget it."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...solvers.errors import InvalidFileError, InvalidMotionError
from ...solvers.motion import Motion, find_humanoid_map, resample
from ...solvers.progress import Progress, unwatched, within
from ...solvers.retargeting import RetargetSettings
from ...solvers.retrieval import Origin
from ...solvers.rotations import IDENTITY
from ..importing.solve_reading import Conversion, convert_recording, read_file
from ..jobs.in_blender import BackgroundBlender, is_read_in_blender, read_blends
from ..retarget.solve_retargeting import RetargetProblem, StagedMotion, Start, retarget_clips
from ..scene.controls import BoneKeys, TargetRig

AS_ARMATURE = Conversion(armature=True, scale=1.0, frame_rate=None)
Keys = Mapping[str, BoneKeys]


@dataclass(frozen=True, eq=False)
class FetchProblem:
    """A clip, and the rig to retarget it to."""

    origin: Origin
    frames: range | None
    """Of the clip, in its own frames; None for all."""
    frame_rate: float
    """Of the keys, hertz."""
    start: Start | None
    target: TargetRig
    settings: RetargetSettings
    blender: BackgroundBlender


@dataclass(frozen=True, eq=False)
class Fetched:
    """The keys of the target."""

    keys: Keys
    n_frames: int


@dataclass(frozen=True, eq=False)
class FetchProblems:
    """Several clips for the same target, and their names."""

    problems: tuple[FetchProblem, ...]
    names: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class FetchedClips:
    """Clips that could be read, None for others, and the first error."""

    clips: tuple[Fetched | None, ...]
    trouble: str


def fetch_clips(requests: FetchProblems, *, progress: Progress = unwatched) -> FetchedClips:
    """Read several clips again, and give them to the target.

    Raises
    ------
    InvalidFileError, InvalidMotionError
        None can be had; see `fetch_clip`.
    """
    found: list[Fetched | None] = []
    troubles: list[InvalidFileError | InvalidMotionError] = []
    n = len(requests.problems)
    for index, (problem, name) in enumerate(
        zip(requests.problems, requests.names, strict=True)
    ):
        progress(index / n, f"Fetching {name}")
        try:
            found.append(
                fetch_clip(problem, progress=within(progress, index / n, (index + 1) / n))
            )
        except (InvalidFileError, InvalidMotionError) as error:
            found.append(None)
            troubles.append(error)
    if len(troubles) == n:
        raise troubles[0]
    return FetchedClips(tuple(found), str(troubles[0]) if troubles else "")


def fetch_clip(problem: FetchProblem, *, progress: Progress = unwatched) -> Fetched:
    """Read a clip again from where it came from, and give it to the target.

    Raises
    ------
    InvalidFileError
        Its file is missing, cannot be read, or has changed so that the clip is not there.
    InvalidMotionError
        It has no bones.
    """
    progress(0.0, "Reading the clip")
    motion = read_origin(problem.origin, problem.blender)
    if problem.frames is not None:
        motion = _part(motion, problem.frames, problem.origin)
    motion = resample(motion, problem.frame_rate)
    clip = StagedMotion(motion, np.zeros(3), np.array(IDENTITY), problem.start)
    roles = find_humanoid_map(motion.skeleton)
    retargeting = RetargetProblem((clip,), roles, problem.target, problem.settings)
    (keys,) = retarget_clips(retargeting, progress=within(progress, 0.3, 1.0))
    return Fetched(keys, motion.n_frames)


def read_origin(origin: Origin, blender: BackgroundBlender) -> Motion:
    """Read the motion of a clip again; see `fetch_clip`."""
    if not Path(origin.path).is_file():
        raise InvalidFileError(
            f"The source file {origin.path} was moved or deleted. Put it back, or build the"
            " library again."
        )
    if is_read_in_blender(origin.path):
        (found,) = read_blends(blender, [origin.path], items=[origin.item])
        if not found.clips:
            why = " ".join(found.refused)
            raise InvalidFileError(
                why
                or f"{origin.path} no longer has the action {origin.item}. Build the library"
                " again."
            )
        return found.clips[0].motion
    wanted = AS_ARMATURE._replace(body=origin.item)
    moving = convert_recording(read_file(Path(origin.path), wanted).recording, AS_ARMATURE)
    if not isinstance(moving, Motion):
        raise InvalidMotionError(f"{origin.path} holds points without bones.")
    return moving


def _part(motion: Motion, frames: range, origin: Origin) -> Motion:
    if frames.stop > motion.n_frames:
        raise InvalidFileError(
            f"{origin.path} has changed. Build the library again, then search again."
        )
    return motion.slice(frames.start, frames.stop)
