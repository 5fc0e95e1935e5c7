"""The verbs of `python -m solvers`."""

import argparse
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..denoising import (
    DenoiseSettings,
    FilterBases,
    FilterBasesSettings,
    JointLimits,
    PlantSettings,
    QualitySettings,
    compare_quality,
    denoise,
    learn_filter_bases,
    learn_joint_limits,
    measure_quality,
    plant_feet,
)
from ..errors import InvalidMotionError, InvalidSettingError
from ..motion import Motion, Tracks
from ..progress import Progress, within
from .files import add_reading_options, read, write
from .options import arguments_from, settings_from_arguments
from .verb import Outcome, Task, Verb


class Learned(NamedTuple):
    """What the clean clips teach."""

    bases: FilterBases | None = None
    limits: JointLimits | None = None


def _denoise_options(parser: argparse.ArgumentParser) -> None:
    add_reading_options(parser)
    parser.add_argument(
        "--train", nargs="+", type=Path, default=[], metavar="FILE",
        help="clean clips to learn from; without them the take's own patterns guide",
    )  # fmt: skip
    parser.add_argument(
        "--joint-limits", action="store_true",
        help="hold joints softly within the angles to which they turn in the clips of --train",
    )  # fmt: skip
    parser.add_argument(
        "--feet", action=argparse.BooleanOptionalAction,
        help="whether to keep standing feet from sliding [default: where there are feet]",
    )  # fmt: skip
    arguments_from(parser, DenoiseSettings, FilterBasesSettings, PlantSettings)


def _learn(arguments: argparse.Namespace, progress: Progress) -> Learned:
    settings = settings_from_arguments(arguments, FilterBasesSettings)
    if not arguments.train:
        if arguments.joint_limits:
            raise InvalidSettingError(
                "Joint limits are learned from clean clips; name some with --train."
            )
        return Learned()
    share = 0.5 / len(arguments.train)
    clips = [
        read(path, arguments, within(progress, share * number, share * (number + 1)))
        for number, path in enumerate(arguments.train)
    ]
    bases = learn_filter_bases(clips, settings=settings, progress=within(progress, 0.5, 0.9))
    if not arguments.joint_limits:
        return Learned(bases)
    bodies = [clip for clip in clips if isinstance(clip, Motion)]
    return Learned(bases, learn_joint_limits(bodies, progress=within(progress, 0.9, 1.0)))


def _denoise(task: Task, learned: Learned, progress: Progress) -> Outcome:
    recording = read(task.source, task.arguments, within(progress, 0.0, 0.1))
    denoised = denoise(
        recording,
        learned.bases,
        limits=learned.limits,
        settings=settings_from_arguments(task.arguments, DenoiseSettings),
        progress=within(progress, 0.1, 0.7),
    )
    clean = denoised.recording
    clean, contacts, feet = _with_feet_planted(
        clean, task.arguments, within(progress, 0.7, 0.8)
    )
    before, after = (
        measure_quality(each, contacts=contacts, progress=within(progress, start, start + 0.07))
        for each, start in ((recording, 0.8), (clean, 0.87))
    )
    write(clean, task.target, within(progress, 0.94, 1.0))
    text = "\n".join([
        denoised.prior_used,
        *([] if denoised.converged else ["The estimate had not settled when it was stopped."]),
        *([feet["feet"]] if "feet" in feet else []),
        compare_quality(before, after),
    ])
    figures = {
        "prior_used": denoised.prior_used,
        "iterations": denoised.iterations,
        "converged": denoised.converged,
        "outliers": int(denoised.outliers.sum()),
        "mean_confidence": float(denoised.confidence.mean()),
        **feet,
        "before": before.figures(),
        "after": after.figures(),
    }
    return Outcome(text, figures)


def _with_feet_planted(
    clean: Motion | Tracks, arguments: argparse.Namespace, progress: Progress
) -> tuple[Motion | Tracks, NDArray[np.bool_] | None, dict[str, Any]]:
    """Return the recording with feet at rest, when they stand, and what to say about them.

    Unless it was asked for, a recording without legs is left as it is.
    """
    settings = settings_from_arguments(arguments, PlantSettings)
    if arguments.feet is False:
        return clean, None, {}
    if isinstance(clean, Tracks):
        if arguments.feet:
            raise InvalidMotionError("Points without a skeleton have no feet to plant.")
        return clean, None, {}
    try:
        planted = plant_feet(clean, settings=settings, progress=progress)
    except InvalidMotionError as error:
        if arguments.feet:
            raise
        return clean, None, {"feet": f"Feet are left as they are. {error}"}
    said = (
        f"Feet slid {100 * planted.slide_before:.1f} cm in all before they were planted, and"
        f" {100 * planted.slide_after:.1f} cm after."
    )
    figures = {"slide_before_m": planted.slide_before, "slide_after_m": planted.slide_after}
    return planted.motion, planted.contacts, {"feet": said, **figures}


def _quality_options(parser: argparse.ArgumentParser) -> None:
    add_reading_options(parser)
    arguments_from(parser, QualitySettings)


def _quality(task: Task, prepared: None, progress: Progress) -> Outcome:
    recording = read(task.source, task.arguments, within(progress, 0.0, 0.5))
    settings = settings_from_arguments(task.arguments, QualitySettings)
    quality = measure_quality(recording, settings=settings, progress=within(progress, 0.5, 1.0))
    return Outcome(quality.report(), quality.figures())


def _convert(task: Task, prepared: None, progress: Progress) -> Outcome:
    recording = read(task.source, task.arguments, within(progress, 0.0, 0.7))
    write(recording, task.target, within(progress, 0.7, 1.0))
    names = recording.skeleton.names if isinstance(recording, Motion) else recording.names
    kind = "joints" if isinstance(recording, Motion) else "points"
    figures = {
        "n_frames": recording.n_frames,
        "frame_rate_hz": recording.frame_rate,
        kind: list(names),
    }
    text = f"{recording.n_frames} frames at {recording.frame_rate:g} Hz, {len(names)} {kind}."
    return Outcome(text, figures)


VERBS = {
    "denoise": Verb(
        "Take jitter, spikes and gaps out of recordings.",
        _denoise_options,
        _denoise,
        prepare=_learn,
    ),
    "quality": Verb(
        "Measure jitter, spikes, gaps and sliding feet.",
        _quality_options,
        _quality,
        writes=False,
    ),
    "convert": Verb(
        "Write recordings of any known format as BVH, or as C3D where they are points.",
        add_reading_options,
        _convert,
    ),
}
"""A new verb is a new entry here."""
