"""Solve of the button Reconstruct: rebuild poses, then plant feet.

The slow part, `solve`, does not depend on the feet: what it returns is kept, so that the redo
panel has only `finish` to repeat.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from ...solvers.denoising import Planted, PlantSettings, Quality, measure_quality
from ...solvers.errors import MocapAssistError
from ...solvers.motion import JointRecording, Motion, Sensor
from ...solvers.progress import Progress, unwatched, within
from ...solvers.reconstruction import (
    ReconstructSettings,
    load_posture_library,
    load_residual_prior,
)
from ...solvers.recordings import read_tracked
from ...solvers.workflows import (
    RebuiltMotion,
    plant_feet_if_possible,
    posture_library_from_clips,
    reconstruct_motion,
)
from ..clean.example_source import ExampleSource
from ..clean.solve_cleaning import blend_motions
from ..library.solve_prior import LibraryPrior


@dataclass(frozen=True, eq=False, kw_only=True)
class RebuildProblem:
    """All that the slow part depends on."""

    body: Motion
    tracking_state: NDArray[np.int8] | None
    """Tracking state of each joint, shape (n_frames, n_joints)."""
    source: tuple[str, int, str] | None
    """The file that the take was imported from, if it is there, its date, and the body."""
    sensor: Sensor
    """The sensor that the take was imported from, as noted on its action."""
    resize: bool
    """Whether location keys can give bones other lengths."""
    settings: ReconstructSettings
    examples: ExampleSource | None
    """Clips of natural postures; None for those that are shipped, or of a file."""
    postures_file: tuple[str, int] | None = None
    """The file of a posture library, and its date."""
    residuals_file: tuple[str, int] | None = None
    """The file of a residual prior, and its date; None for the one that is shipped."""
    library: LibraryPrior | None = None
    """Library to find clips of natural poses in, instead of examples."""


@dataclass(frozen=True, eq=False, kw_only=True)
class RebuildFinish:
    """Settings that apply the solution to the take."""

    ease: Array
    """Blend weights, shape (n_frames,): below 1 only next to unchanged frames."""
    planting: PlantSettings | None
    """None leaves the feet alone."""
    contacts: Array | None
    """Contacts that the animator keyed, shape (n_frames, 7); NaN where they are detected."""


@dataclass(frozen=True, eq=False)
class Rebuilt:
    """Motion to write, and remarks to report."""

    motion: Motion
    solution: RebuiltMotion
    planted: Planted | None
    remarks: tuple[str, ...]
    before: Quality
    """Of the recording, its feet measured at the contacts at which they were planted."""
    after: Quality


def solve(problem: RebuildProblem, *, progress: Progress = unwatched) -> RebuiltMotion:
    """Rebuild the poses of the body."""
    postures, prior, message = None, None, ""
    sharing = within(progress, 0.0, 0.2)
    if problem.postures_file is not None:
        postures = load_posture_library(problem.postures_file[0])
    if problem.residuals_file is not None:
        prior = load_residual_prior(problem.residuals_file[0])
    if problem.library is not None:
        matches = problem.library.postures(problem.body, sharing)
        postures, message = matches.postures, matches.message
    elif problem.examples is not None:
        clips, message = problem.examples.read()
        postures = posture_library_from_clips(clips, progress=sharing)
    rebuilt = reconstruct_motion(
        problem.body,
        postures,
        prior,
        source=read_source(problem),
        tracking_state=problem.tracking_state,
        sensor=problem.sensor,
        resize=problem.resize,
        settings=problem.settings,
        progress=within(progress, 0.2, 1.0),
    )
    return replace(rebuilt, remarks=(message, *rebuilt.remarks)) if message else rebuilt


def read_source(problem: RebuildProblem) -> JointRecording | None:
    """Return the recording of a take, if its file is still there and readable."""
    if problem.source is None:
        return None
    path, _, body = problem.source
    try:
        recording = read_tracked(path, body=body)
    except MocapAssistError:
        return None
    return recording if isinstance(recording, JointRecording) else None


def rebuild(
    problem: RebuildProblem,
    finish: RebuildFinish,
    solution: RebuiltMotion | None = None,
    *,
    progress: Progress = unwatched,
) -> Rebuilt:
    """Solve the problem, unless its solution is given, and finish it."""
    if solution is None:
        solution = solve(problem, progress=within(progress, 0.0, 0.8))
    motion, planted, remarks = plant_feet_if_possible(
        solution.motion,
        finish.planting,
        finish.contacts,
        reliability=solution.reliability,
        progress=within(progress, 0.8, 0.9),
    )
    motion = _blend_outside(problem.body, motion, finish.ease)
    contacts = None if planted is None else planted.contacts
    before, after = (
        measure_quality(each, contacts=contacts, progress=within(progress, start, start + 0.05))
        for each, start in ((problem.body, 0.9), (motion, 0.95))
    )
    return Rebuilt(motion, solution, planted, (*solution.remarks, *remarks), before, after)


def _blend_outside(raw: Motion, motion: Motion, ease: Array) -> Motion:
    """Blend into the frames outside, where the recording has data."""
    if (ease == 1.0).all():
        return motion
    observed = np.isfinite(raw.rotations).all(axis=-1, keepdims=True)
    placed = np.isfinite(raw.root_positions).all(axis=-1, keepdims=True)
    start = motion.with_poses(
        np.where(observed, raw.rotations, motion.rotations),
        np.where(placed, raw.root_positions, motion.root_positions),
    )
    return blend_motions(start, motion, ease[:, None])
