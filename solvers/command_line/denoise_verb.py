"""`denoise`: remove jitter, spikes and gaps, optionally guided by clean clips."""

import argparse
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..denoising import (
    Denoised,
    DenoiseSettings,
    FilterBases,
    FilterBasesSettings,
    PlantSettings,
    compare_quality,
    denoise,
    learn_filter_bases,
    learn_joint_limits,
    load_filter_bases,
    measure_quality,
    plant_feet,
)
from ..errors import InvalidMotionError, InvalidSettingError
from ..markers import Swap, unswap_markers
from ..motion import JointLimits, Motion, Tracks
from ..progress import Progress, within
from .arguments import (
    Outcome,
    Task,
    VerbWork,
    add_preset_option,
    add_reading_options,
    arguments_from,
    read,
    read_all,
    settings_from_arguments,
    with_body,
    write,
)
from .from_library import add_library_option, check_library, learn_bases


class LearnedPrior(NamedTuple):
    """Bases and joint limits learned from clean clips."""

    bases: FilterBases | None = None
    limits: JointLimits | None = None


def add_denoise_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `denoise`."""
    add_reading_options(parser)
    add_preset_option(parser, "denoise")
    examples = parser.add_mutually_exclusive_group()
    examples.add_argument(
        "--train", nargs="+", type=Path, default=[], metavar="FILE",
        help="Clean clips to learn from [default: patterns of the take itself]",
    )  # fmt: skip
    examples.add_argument(
        "--bases", type=Path, metavar="FILE",
        help="Bases learned from clean clips by the verb learn or the button Learn",
    )  # fmt: skip
    add_library_option(examples)
    parser.add_argument(
        "--joint-limits", action="store_true",
        help="Limit joints softly to the range of rotation in the clips of --train",
    )  # fmt: skip
    parser.add_argument(
        "--unswap", action="store_true",
        help="Correct swapped and wrong labels of optical markers first",
    )  # fmt: skip
    parser.add_argument(
        "--feet", action=argparse.BooleanOptionalAction,
        help="Plant standing feet [default: where there are feet]",
    )  # fmt: skip
    for title, settings in (
        ("denoising", DenoiseSettings),
        ("learning from --train", FilterBasesSettings),
        ("planting feet", PlantSettings),
    ):
        arguments_from(parser.add_argument_group(title), settings)


def learn_prior(arguments: argparse.Namespace, progress: Progress) -> LearnedPrior:
    """Learn or load the prior for all files of a run.

    Raises
    ------
    InvalidFileError
        An example or the file of bases is missing or damaged.
    InvalidMotionError
        Nothing can be learned from the examples.
    InvalidSettingError
        An option needs clean clips, and none are given.
    """
    settings = settings_from_arguments(arguments, FilterBasesSettings)
    if not arguments.train:
        _check_clip_options(arguments)
        check_library(arguments.library)
        return LearnedPrior(arguments.bases and load_filter_bases(arguments.bases))
    clips = read_all(arguments.train, with_body(arguments, ""), within(progress, 0.0, 0.5))
    bases = learn_filter_bases(clips, settings=settings, progress=within(progress, 0.5, 0.9))
    if not arguments.joint_limits:
        return LearnedPrior(bases)
    bodies = [clip for clip in clips if isinstance(clip, Motion)]
    return LearnedPrior(bases, learn_joint_limits(bodies, progress=within(progress, 0.9, 1.0)))


def _check_clip_options(arguments: argparse.Namespace) -> None:
    if arguments.joint_limits:
        raise InvalidSettingError("Joint limits need clean clips; name some with --train.")
    for item in fields(FilterBasesSettings) if arguments.library is None else ():
        if hasattr(arguments, item.name):
            raise InvalidSettingError(
                f"--{item.name.replace('_', '-')} is an option for learning. Name clean clips"
                " with --train or --library, or use it with the verb learn."
            )


def perform_denoise(task: Task, learned: LearnedPrior, progress: Progress) -> Outcome:
    """Clean one recording, write it and report its quality before and after."""
    recording = read(task.source, task.arguments, within(progress, 0.0, 0.05))
    unswapped_recording, swaps = _unswap_labels(
        recording, task.arguments, within(progress, 0.05, 0.1)
    )
    denoised = _denoise(unswapped_recording, task, learned, within(progress, 0.1, 0.7))
    clean = denoised.recording
    clean, contacts, feet = _plant_feet(clean, task.arguments, within(progress, 0.7, 0.8))
    before, after = (
        measure_quality(each, contacts=contacts, progress=within(progress, start, start + 0.07))
        for each, start in ((recording, 0.8), (clean, 0.87))
    )
    write(clean, task.target, within(progress, 0.94, 1.0))
    text = "\n".join([
        denoised.report(),
        *([] if denoised.converged else ["The estimate did not converge."]),
        *([f"{len(swaps)} swapped labels were corrected."] if swaps else []),
        *([feet["feet"]] if "feet" in feet else []),
        compare_quality(before, after),
    ])
    figures = {
        "prior_used": denoised.report(),
        "iterations": denoised.iterations,
        "converged": denoised.converged,
        "outliers": int(denoised.outliers.sum()),
        "swaps": len(swaps),
        "mean_confidence": float(denoised.confidence.mean()),
        **feet,
        "before": before.figures(),
        "after": after.figures(),
    }
    return Outcome(text, figures)


def _denoise(
    recording: Motion | Tracks, task: Task, learned: LearnedPrior, progress: Progress
) -> Denoised:
    """Denoise with the prior of the run, or with one from similar clips of the library."""
    bases, message = learned.bases, ""
    settings = settings_from_arguments(task.arguments, DenoiseSettings)
    if task.arguments.library is not None:
        finding, progress = within(progress, 0.0, 0.5), within(progress, 0.5, 1.0)
        found = learn_bases(recording, task.source, task.arguments, finding)
        bases, message = found.bases, found.message
    denoised = denoise(
        recording, bases, limits=learned.limits, settings=settings, progress=progress
    )
    return replace(denoised, prior_used=f"{message} {denoised.prior_used}".lstrip())


def _unswap_labels(
    recording: Motion | Tracks, arguments: argparse.Namespace, progress: Progress
) -> tuple[Motion | Tracks, tuple[Swap, ...]]:
    """Return the recording with corrected labels, if requested, and the swaps."""
    if not arguments.unswap:
        return recording, ()
    if isinstance(recording, Motion):
        raise InvalidMotionError("Only markers have labels that can be swapped.")
    unswapped = unswap_markers(recording, progress=progress)
    return unswapped.tracks, unswapped.swaps


def _plant_feet(
    clean: Motion | Tracks, arguments: argparse.Namespace, progress: Progress
) -> tuple[Motion | Tracks, NDArray[np.bool_] | None, dict[str, Any]]:
    """Return the recording with planted feet, its contacts, and figures to report.

    A recording without legs is returned unchanged, unless --feet is given.
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
        return clean, None, {"feet": f"Feet were not planted. {error}"}
    message = (
        f"The slide on the floor was {100 * planted.slide_before:.1f} cm in total before"
        f" planting, and {100 * planted.slide_after:.1f} cm after."
    )
    figures = {"slide_before_m": planted.slide_before, "slide_after_m": planted.slide_after}
    return planted.motion, planted.contacts, {"feet": message, **figures}


DENOISE = VerbWork(add_denoise_options, perform_denoise, prepare=learn_prior)
