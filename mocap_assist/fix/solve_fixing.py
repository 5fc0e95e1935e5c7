"""Solve of the button Fix My Take: `fix_take`, and its result in the form of other buttons."""

from dataclasses import dataclass, replace

from ...solvers.arrays import Array, Flags
from ...solvers.denoising import Denoised, denoise
from ...solvers.depth_scene import DepthRecording
from ...solvers.motion import JointLimits, Motion, Tracks
from ...solvers.progress import Progress, unwatched, within
from ...solvers.workflows import (
    FixedTake,
    FixSettings,
    MarkerMotion,
    MotionFromJoints,
    RebuiltMotion,
    fix_take,
)
from ..clean.solve_cleaning import Cleaned, Problem, Solution, names_of
from ..reconstruct.solve_reconstructing import RebuildProblem, Rebuilt, read_source
from ..track.pose_previews import PosePreviewSender, Show, no_preview
from ..track.solve_tracking import Tracked, build_tracked

TREE_FRACTION = 0.9
"""Fraction of the time until the body is fixed. It only moves the progress bar: chosen by hand
for one or two props."""


@dataclass(frozen=True, eq=False)
class FixedDepth:
    """What Track would write, and the motion after the other steps."""

    tracked: Tracked
    motion: Motion


@dataclass(frozen=True, eq=False)
class Fixed:
    """A fixed take, and it in the form of the button that writes it."""

    written: Cleaned | Rebuilt | MarkerMotion | FixedDepth
    """What Clean, Reconstruct, Make Skeleton or Track would write."""
    take: FixedTake


def fix(
    problem: Problem | RebuildProblem | Tracks | DepthRecording,
    settings: FixSettings,
    *,
    contacts: Flags | Array | None = None,
    limits: JointLimits | None = None,
    show: Show = no_preview,
    progress: Progress = unwatched,
) -> Fixed:
    """Fix a take: that of Clean, of Reconstruct, of Make Skeleton or of Track.

    Of depth images, the tracked poses are sent as previews to a `PosePreviewReceiver`.
    """
    fixed = fix_take(
        _take_of(problem),
        settings=settings,
        contacts=contacts,
        limits=limits,
        on_pose=PosePreviewSender(show),
        progress=within(progress, 0.0, TREE_FRACTION),
    )
    match problem:
        case Problem():
            written: Cleaned | Rebuilt | MarkerMotion | FixedDepth = _cleaned_from_fixed(
                problem, fixed, within(progress, TREE_FRACTION, 1.0)
            )
        case RebuildProblem():
            written = _rebuilt_from_fixed(fixed)
        case Tracks():
            written = _solved_from_fixed(fixed)
        case DepthRecording():
            written = _tracked_from_fixed(fixed)
    progress(1.0, "Done")
    return Fixed(written, fixed)


def _take_of(
    problem: Problem | RebuildProblem | Tracks | DepthRecording,
) -> Motion | Tracks | MotionFromJoints | DepthRecording:
    match problem:
        case Problem():
            return problem.recordings[0]
        case RebuildProblem():
            return MotionFromJoints(
                problem.body,
                read_source(problem),
                problem.tracking_state,
                problem.sensor,
                problem.resize,
            )
        case _:
            return problem


def _cleaned_from_fixed(problem: Problem, fixed: FixedTake, progress: Progress) -> Cleaned:
    """Clean the other trees of an armature, such as props, too."""
    other_trees = problem.recordings[1:]
    chain = fixed.chain
    assert chain.denoised is not None
    denoised: list[Denoised] = [chain.denoised]
    for index, tree in enumerate(other_trees):
        start, stop = (each / len(other_trees) for each in (index, index + 1))
        denoised.append(
            denoise(tree, settings=problem.settings, progress=within(progress, start, stop))
        )
    solution = Solution(tuple(denoised), None)
    if chain.unswapped is not None:
        solution = replace(
            solution, unswapped=chain.unswapped.tracks, swaps=chain.unswapped.swaps
        )
    recordings = (fixed.recording, *(each.recording for each in denoised[1:]))
    moved = frozenset(name for each in recordings for name in names_of(each))
    before, after = fixed.before.quality, fixed.after.quality
    return Cleaned(recordings, moved, solution, chain.planted, before, after)


def _rebuilt_from_fixed(fixed: FixedTake) -> Rebuilt:
    chain, solution = fixed.chain, fixed.chain.rebuilt
    assert isinstance(solution, RebuiltMotion) and isinstance(fixed.recording, Motion)
    remarks = chain.planted.remarks if chain.planted else ()
    return Rebuilt(
        fixed.recording,
        solution,
        chain.planted,
        (*solution.remarks, *(f"{remark}." for remark in remarks)),
        fixed.before.quality,
        fixed.after.quality,
    )


def _solved_from_fixed(fixed: FixedTake) -> MarkerMotion:
    solved = fixed.chain.solved
    assert solved is not None and isinstance(fixed.recording, Motion)
    return replace(solved, motion=fixed.recording)


def _tracked_from_fixed(fixed: FixedTake) -> FixedDepth:
    captured = fixed.chain.captured
    assert captured is not None and isinstance(fixed.recording, Motion)
    tracked = build_tracked(
        0, captured.motion, captured.captured, captured.actor.floor, captured.remarks
    )
    return FixedDepth(tracked, fixed.recording)
