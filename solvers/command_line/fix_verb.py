"""`fix`: fix takes of any origin with the steps that suit each."""

import argparse

from ..depth_scene import DepthRecording
from ..errors import InvalidMotionError
from ..motion import JointRecording, Motion, Tracks
from ..progress import Progress, within
from ..recordings import FloorPlacementSettings, is_depth_recording, read_depth, takes_in
from ..workflows import (
    FixedTake,
    FixSettings,
    TakeOrigin,
    describe_missing_points,
    drop_missing_points,
    figure_texts,
    find_origin,
    fix_take,
)
from .arguments import (
    Outcome,
    Task,
    VerbWork,
    add_reading_options,
    arguments_from,
    read_on_floor,
    settings_from_arguments,
    write,
)


def add_fix_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `fix`."""
    add_reading_options(parser)
    arguments_from(parser, FloorPlacementSettings)
    arguments_from(parser, FixSettings)


def perform_fix(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Fix one take, write its motion and report what was done."""
    recording, placed = _read(task, within(progress, 0.0, 0.1))
    if find_origin(recording) is TakeOrigin.POINTS:
        _, never_observed = drop_missing_points(recording)
        missing = describe_missing_points(never_observed)
        raise InvalidMotionError(
            f"{task.source} holds points of no marker set that a skeleton can be solved from."
            f" {missing} Use denoise, which cleans them as points.".replace("  ", " ")
        )
    settings = settings_from_arguments(task.arguments, FixSettings)
    fixed = fix_take(recording, settings=settings, progress=within(progress, 0.1, 0.95))
    write(fixed.recording, task.target, within(progress, 0.95, 1.0))
    return Outcome("\n".join((*placed, _summary(fixed))), _figures(fixed))


def _read(
    task: Task, progress: Progress
) -> tuple[Motion | Tracks | JointRecording | DepthRecording, tuple[str, ...]]:
    """Read a take, on the floor, and report if it was put there."""
    if is_depth_recording(task.source):
        return read_depth(task.source, progress=progress), ()
    return read_on_floor(task.source, task.arguments, progress)


def _summary(fixed: FixedTake) -> str:
    figures = fixed.figures()
    lines = [*fixed.steps, f"{'':<20}{'before':>10}{'after':>10}"]
    for label, before, after in figure_texts(figures["before"], figures["after"]):
        lines.append(f"{label:<20}{before:>10}{after:>10}")
    return "\n".join(lines)


def _figures(fixed: FixedTake) -> dict[str, object]:
    assert isinstance(fixed.recording, Motion)
    return {
        "n_frames": fixed.recording.n_frames,
        "frame_rate_hz": fixed.recording.frame_rate,
        **fixed.figures(),
    }


FIX = VerbWork(add_fix_options, perform_fix, list_recordings=takes_in)
