"""`solve`: solve the motion of a skeleton from labeled optical markers."""

import argparse

import numpy as np

from ..errors import InvalidMotionError
from ..markers import SolveSettings
from ..motion import Tracks
from ..progress import Progress, within
from ..workflows import MarkerMotion, MarkerMotionSettings, motion_from_markers
from .arguments import (
    Outcome,
    Task,
    VerbWork,
    add_reading_options,
    arguments_from,
    read,
    settings_from_arguments,
    write,
)

MAX_LISTED_SWAPS = 5


def add_solve_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `solve`."""
    add_reading_options(parser)
    arguments_from(parser, MarkerMotionSettings)
    arguments_from(parser.add_argument_group("solving"), SolveSettings)


def perform_solve(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Solve one take, write its motion and report the marker error."""
    recording = read(task.source, task.arguments, within(progress, 0.0, 0.1))
    if not isinstance(recording, Tracks):
        raise InvalidMotionError(
            f"{task.source} already has a skeleton; solve is for markers. Use denoise or"
            " convert."
        )
    result = motion_from_markers(
        recording,
        settings=settings_from_arguments(task.arguments, MarkerMotionSettings),
        solving=settings_from_arguments(task.arguments, SolveSettings),
        progress=within(progress, 0.1, 0.95),
    )
    write(result.motion, task.target, within(progress, 0.95, 1.0))
    return Outcome(_summary(result), _figures(result))


def _figures(result: MarkerMotion) -> dict[str, object]:
    error = result.solved.error
    return {
        "n_frames": result.motion.n_frames,
        "frame_rate_hz": result.motion.frame_rate,
        "joints": list(result.motion.skeleton.names),
        "marker_set": result.solved.marker_set.name,
        "markers": list(result.solved.markers),
        "error_m": float(np.nanmean(error)),
        "worst_error_m": float(np.nanmax(error)),
        "filled_samples": int(result.filled.sum()),
        "unknown_samples": int((~result.solved.motion.observed).sum()),
        "swaps": [
            {"names": list(swap.names), "first": swap.frames.start, "stop": swap.frames.stop}
            for swap in result.swaps
        ],
    }


def _summary(result: MarkerMotion) -> str:
    solved, error = result.solved, result.solved.error
    lines = [
        f"{solved.marker_set.name}: {len(solved.markers)} markers, {result.motion.n_frames}"
        f" frames at {result.motion.frame_rate:g} Hz, {result.motion.n_joints} joints.",
        f"The mean marker error is {1000 * np.nanmean(error):.1f} mm.",
    ]
    lines += [
        f"Labels of {' and '.join(swap.names)} were wrong in frames {swap.frames.start + 1} to"
        f" {swap.frames.stop}."
        for swap in result.swaps[:MAX_LISTED_SWAPS]
    ]
    if len(result.swaps) > MAX_LISTED_SWAPS:
        lines.append(f"So were {len(result.swaps) - MAX_LISTED_SWAPS} more.")
    if result.filled.any():
        lines.append(f"{result.filled.sum()} samples of missing markers were filled.")
    unobserved = (~solved.motion.observed).any(axis=1).sum()
    if unobserved:
        lines.append(f"In {unobserved} frames, joints without markers were filled.")
    return "\n".join(lines)


SOLVE = VerbWork(add_solve_options, perform_solve)
