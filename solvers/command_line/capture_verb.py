"""`capture`: track the actor of a depth recording."""

import argparse
from pathlib import Path

import numpy as np

from ..denoising import PlantSettings
from ..depth_scene import ForegroundSettings
from ..depth_tracking.body import LENGTHS, BodyModel, load_body_model
from ..depth_tracking.capturing import CaptureSettings
from ..errors import InvalidSettingError
from ..motion import JointRecording, Sensor
from ..progress import Progress, Remark, collect_remarks, within
from ..recordings import depth_takes_in, read_depth, write_joint_csv
from ..recordings.depth_files import DepthSettings
from ..workflows import CapturedMotion, capture_recording
from ..workflows.following import FollowedMotion
from .arguments import (
    JOINTS,
    Outcome,
    Task,
    VerbWork,
    arguments_from,
    find_recordings,
    settings_from_arguments,
    write,
)
from .follow_recording import add_follow_options, check_follow, follow_recording


def add_capture_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `capture`."""
    parser.add_argument(
        "--body", type=Path, metavar="FILE",
        help="Body of the actor, written by --keep-body [default: fitted to the recording]",
    )  # fmt: skip
    parser.add_argument(
        "--keep-body", type=Path, metavar="FILE", help="Also write the fitted body"
    )
    parser.add_argument(
        "--empty", nargs=2, type=int, metavar=("FIRST", "LAST"),
        help="Frames of the empty room, for background subtraction",
    )  # fmt: skip
    parser.add_argument(
        "--joints", action="store_true",
        help="With --output-folder: write joints with confidence as .csv, in camera space,"
        " instead of the motion of a skeleton",
    )  # fmt: skip
    parser.add_argument(
        "--feet", action=argparse.BooleanOptionalAction, default=True,
        help="Plant standing feet [default: yes, where they are visible]",
    )  # fmt: skip
    add_follow_options(parser)
    for title, settings in (
        ("reading", DepthSettings), ("the actor", ForegroundSettings),
        ("tracking", CaptureSettings), ("planting feet", PlantSettings),
    ):  # fmt: skip
        arguments_from(parser.add_argument_group(title), settings)


def read_body(arguments: argparse.Namespace, progress: Progress) -> BodyModel | None:
    """Read the body for all files of a run, if one is given.

    Raises
    ------
    InvalidSettingError
        --keep-body is combined with several takes, or --follow with a folder for results.
    """
    check_follow(arguments)
    many = arguments.output_folder is not None and len(
        find_recordings(arguments.files, list_recordings=depth_takes_in)
    )
    if arguments.keep_body is not None and many > 1:
        raise InvalidSettingError(
            f"{arguments.keep_body} can hold one body. Capture one take with --keep-body,"
            " and the others with --body."
        )
    return None if arguments.body is None else load_body_model(arguments.body)


def perform_capture(task: Task, prepared: BodyModel | None, progress: Progress) -> Outcome:
    """Capture one recording, write it and report the quality of the tracking."""
    arguments, messages = task.arguments, list[Remark]()
    found: CapturedMotion | FollowedMotion
    if arguments.follow:
        found = follow_recording(task.source, arguments, prepared, within(progress, 0.0, 0.98))
    else:
        found = _capture_complete(task, prepared, messages, within(progress, 0.0, 0.98))
    if arguments.keep_body is not None:
        found.captured.body.save(arguments.keep_body)
    assert task.target is not None
    if task.target.suffix.lower() == JOINTS:
        joints = JointRecording(found.captured.joints, None, Sensor.OTHER)
        write_joint_csv(joints, task.target, progress=within(progress, 0.98, 1.0))
    else:
        write(found.motion, task.target, within(progress, 0.98, 1.0))
    return _outcome(found, messages)


def _capture_complete(
    task: Task, body: BodyModel | None, messages: list[Remark], progress: Progress
) -> CapturedMotion:
    arguments = task.arguments
    recording = read_depth(
        task.source,
        settings_from_arguments(arguments, DepthSettings),
        progress=collect_remarks(within(progress, 0.0, 0.02), messages),
    )
    first, last = arguments.empty or (0, -1)
    return capture_recording(
        recording,
        body,
        empty=range(first, last + 1),
        settings=settings_from_arguments(arguments, CaptureSettings),
        foreground=settings_from_arguments(arguments, ForegroundSettings),
        planting=settings_from_arguments(arguments, PlantSettings) if arguments.feet else None,
        progress=within(progress, 0.02, 1.0),
    )


def _outcome(found: CapturedMotion | FollowedMotion, messages: list[Remark]) -> Outcome:
    captured, remarks = (
        found.captured,
        [*(f"{message.rstrip('.')}." for message in messages), *found.remarks],
    )
    restarts = len(captured.restarts)
    times = "once" if restarts == 1 else f"{restarts} times"
    distance_cm, overlap = 100 * np.nanmean(captured.residual), 100 * captured.coverage.mean()
    text = (
        f"{found.motion.n_frames} frames, {distance_cm:.1f} cm from the depth pixels"
        f" on average, with {overlap:.0f} % overlap. The detector ran {times} after the start."
    )
    figures = {
        "n_frames": found.motion.n_frames,
        "frame_rate_hz": found.motion.frame_rate,
        "residual_m": float(np.nanmean(captured.residual)),
        "coverage": float(captured.coverage.mean()),
        "restarts": list(captured.restarts),
        "doubtful_share": float(captured.low_confidence.mean()),
        "bone_lengths_m": dict(zip(LENGTHS, captured.body.lengths.tolist(), strict=True)),
        "remarks": remarks,
        "slide_before_m": found.planted and found.planted.slide_before,
        "slide_after_m": found.planted and found.planted.slide_after,
    }
    if isinstance(found, FollowedMotion):
        figures |= {
            "first_frame": found.first,
            "n_images": len(found.delays),
            "n_dropped": found.n_dropped,
            "median_delay_s": float(np.median(found.delays)),
        }
    return Outcome(" ".join([text, *remarks]), figures)


CAPTURE = VerbWork(add_capture_options, perform_capture, depth_takes_in, read_body)
