"""`capture`: track the actor of a depth recording."""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypedDict

import numpy as np

from ..denoising import PlantSettings
from ..depth_scene import DepthRecording, ForegroundSettings
from ..depth_tracking.body import LENGTHS, BodyModel
from ..depth_tracking.capturing import CaptureSettings
from ..depth_tracking.several_cameras import AlignmentSettings
from ..motion import JointRecording, Sensor
from ..progress import Progress, Remark, collect_remarks, within
from ..recordings import depth_takes_in, read_depth, write_joint_csv
from ..recordings.depth_files import DepthSettings
from ..workflows import (
    CapturedMotion,
    capture_every_person,
    capture_from_cameras,
    capture_recording,
)
from ..workflows.following import FollowedMotion
from .arguments import (
    JOINTS,
    Outcome,
    Task,
    VerbWork,
    settings_from_arguments,
    write,
)
from .batches import (
    check_files_of_people,
    check_is_no_person,
    left_of_earlier_run,
    path_of_person,
)
from .capture_options import add_capture_options, read_body
from .follow_recording import follow_recording


def perform_capture(task: Task, prepared: BodyModel | None, progress: Progress) -> Outcome:
    """Capture one recording, write it and report the quality of the tracking."""
    arguments, messages = task.arguments, list[Remark]()
    found: CapturedMotion | FollowedMotion
    check_is_no_person(task)
    if arguments.follow:
        found = follow_recording(task.source, arguments, prepared, within(progress, 0.0, 0.98))
    elif arguments.people == 1:
        found = _capture_actor(task, prepared, messages, within(progress, 0.0, 0.98))
    else:
        people = _capture_people(task, messages, within(progress, 0.0, 0.98))
        return _write_people(people, task, messages, within(progress, 0.98, 1.0))
    if arguments.keep_body is not None:
        found.captured.body.save(arguments.keep_body)
    assert task.target is not None
    _write(found, task.target, within(progress, 0.98, 1.0))
    return _outcome(found, messages)


class _Options(TypedDict):
    empty: range
    settings: CaptureSettings
    foreground: ForegroundSettings
    planting: PlantSettings | None
    progress: Progress


def _options(arguments: argparse.Namespace, progress: Progress) -> _Options:
    first, last = arguments.empty or (0, -1)
    planting = settings_from_arguments(arguments, PlantSettings) if arguments.feet else None
    return {
        "empty": range(first, last + 1),
        "settings": settings_from_arguments(arguments, CaptureSettings),
        "foreground": settings_from_arguments(arguments, ForegroundSettings),
        "planting": planting,
        "progress": progress,
    }


def _read(
    paths: Sequence[Path], task: Task, messages: list[Remark], progress: Progress
) -> list[DepthRecording]:
    """Open recordings."""
    settings = settings_from_arguments(task.arguments, DepthSettings)
    return [
        read_depth(path, settings, progress=collect_remarks(progress, messages))
        for path in paths
    ]


def _capture_actor(
    task: Task, body: BodyModel | None, messages: list[Remark], progress: Progress
) -> CapturedMotion:
    """Capture one person, before one or several cameras."""
    arguments = task.arguments
    paths = task.source, *arguments.camera
    recordings = _read(paths, task, messages, within(progress, 0.0, 0.02))
    options = _options(arguments, within(progress, 0.02, 1.0))
    if len(recordings) == 1:
        return capture_recording(recordings[0], body, **options)
    alignment = settings_from_arguments(arguments, AlignmentSettings)
    return capture_from_cameras(recordings, body, alignment=alignment, **options)


def _capture_people(
    task: Task, messages: list[Remark], progress: Progress
) -> Sequence[CapturedMotion]:
    """Capture several people together.

    Raises InvalidFileError if their files would replace those of another take.
    """
    check_files_of_people(task, task.arguments.people)
    (recording,) = _read([task.source], task, messages, within(progress, 0.0, 0.02))
    options = _options(task.arguments, within(progress, 0.02, 1.0))
    return capture_every_person(recording, n_people=task.arguments.people or None, **options)


def _write_people(
    people: Sequence[CapturedMotion],
    task: Task,
    messages: Sequence[Remark],
    progress: Progress,
) -> Outcome:
    """Write each person to a file of its own, the most visible one, the target, last."""
    assert task.target is not None
    check_files_of_people(task, len(people))  # Another process may have written meanwhile.
    targets = [path_of_person(task.target, number) for number in range(1, len(people) + 1)]
    for written, index in enumerate(reversed(range(len(people)))):
        part = within(progress, written / len(people), (written + 1) / len(people))
        _write(people[index], targets[index], part)
    outcomes = [
        _outcome(found, messages if index == 0 else []) for index, found in enumerate(people)
    ]
    lines = [
        f"Person {number}, {target.name}: {outcome.text}"
        for number, (target, outcome) in enumerate(zip(targets, outcomes, strict=True), start=1)
    ]
    lines += [
        f"{path.name} was there before: it is no person of this take."
        for path in left_of_earlier_run(task.target, len(people))
    ]
    figures = {
        "people": [
            {"output": str(target), **outcome.figures}
            for target, outcome in zip(targets, outcomes, strict=True)
        ]
    }
    return Outcome("\n".join(lines), figures)


def _write(found: CapturedMotion | FollowedMotion, target: Path, progress: Progress) -> None:
    if target.suffix.lower() == JOINTS:
        joints = JointRecording(found.captured.joints, None, Sensor.OTHER)
        write_joint_csv(joints, target, progress=progress)
    else:
        write(found.motion, target, progress)


def _outcome(found: CapturedMotion | FollowedMotion, messages: Sequence[Remark]) -> Outcome:
    captured, remarks = (
        found.captured,
        [*(f"{message.rstrip('.')}." for message in messages), *found.remarks],
    )
    restarts, coverage = len(captured.restarts), captured.mean_coverage
    times = "once" if restarts == 1 else f"{restarts} times"
    text = (
        f"{found.motion.n_frames} frames, {100 * np.nanmean(captured.residual):.1f} cm from the"
        f" depth pixels on average, with {100 * coverage:.0f} % overlap."
    )
    if not (isinstance(found, CapturedMotion) and found.alignments):
        text += f" The detector ran {times} after the start."
    figures: dict[str, Any] = {
        "n_frames": found.motion.n_frames,
        "frame_rate_hz": found.motion.frame_rate,
        "residual_m": float(np.nanmean(captured.residual)),
        "coverage": coverage,
        "restarts": list(captured.restarts),
        "doubtful_share": float(captured.low_confidence.mean()),
        "bone_lengths_m": dict(zip(LENGTHS, captured.body.lengths.tolist(), strict=True)),
        "remarks": remarks,
        "slide_before_m": found.planted and found.planted.slide_before,
        "slide_after_m": found.planted and found.planted.slide_after,
    }
    if isinstance(found, CapturedMotion) and found.alignments:
        figures["cameras"] = [
            {
                "first_from_camera": np.linalg.inv(each.camera_from_first).tolist(),
                "offset_s": each.offset,
                "mismatch_m": each.mismatch,
            }
            for each in found.alignments
        ]
    if isinstance(found, FollowedMotion):
        figures |= {
            "first_frame": found.first,
            "n_images": len(found.delays),
            "n_dropped": found.n_dropped,
            "median_delay_s": float(np.median(found.delays)),
        }
    return Outcome(" ".join([text, *remarks]), figures)


CAPTURE = VerbWork(add_capture_options, perform_capture, depth_takes_in, read_body)
