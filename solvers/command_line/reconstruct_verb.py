"""`reconstruct`: rebuild clean poses from the joints of a depth camera."""

import argparse
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..denoising import Planted, PlantSettings, compare_quality, measure_quality
from ..errors import InvalidMotionError
from ..motion import JointRecording, Motion, Sensor, Tracks
from ..progress import Progress, within
from ..reconstruction import (
    PostureLibrary,
    ReconstructSettings,
    ResidualPrior,
    load_posture_library,
    load_residual_prior,
)
from ..recordings import FloorPlacementSettings, write_joint_csv
from ..workflows import (
    plant_feet_if_possible,
    posture_library_from_clips,
    reconstruct_motion,
    reconstruct_recording,
)
from .arguments import (
    JOINTS,
    Outcome,
    Task,
    VerbWork,
    add_preset_option,
    add_reading_options,
    arguments_from,
    read_all,
    read_on_floor,
    settings_from_arguments,
    with_body,
    write,
)
from .from_library import add_library_option, check_library, collect_postures


class RebuiltTake(NamedTuple):
    """The result for one recording, of joints or of a skeleton."""

    motion: Motion
    joints: JointRecording | None
    fraction: float
    """Fraction of the joints and frames that were rebuilt."""
    method: str
    remarks: tuple[str, ...]
    slide: tuple[float, float] | None
    """Slide of the feet before and after planting, meters."""


def add_reconstruct_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `reconstruct`."""
    add_reading_options(parser)
    arguments_from(parser, FloorPlacementSettings)
    add_preset_option(parser, "reconstruct")
    postures = parser.add_mutually_exclusive_group()
    add_library_option(postures)
    postures.add_argument(
        "--train", nargs="+", type=Path, default=[], metavar="FILE",
        help="Clean clips of skeletons, or folders of them, to learn postures from"
        " [default: the shipped postures]",
    )  # fmt: skip
    postures.add_argument(
        "--postures", type=Path, metavar="FILE",
        help="A posture library of your own, written by learn-postures",
    )  # fmt: skip
    parser.add_argument(
        "--residuals", type=Path, metavar="FILE",
        help="Residual prior of the sensor, written by learn-residuals [default: Kinect v2]",
    )  # fmt: skip
    parser.add_argument(
        "--joints", action="store_true",
        help="With --output-folder: write joints with their confidence as .csv, instead of the"
        " motion of a skeleton",
    )  # fmt: skip
    parser.add_argument(
        "--feet", action=argparse.BooleanOptionalAction, default=True,
        help="Plant standing feet [default: yes, where there are feet]",
    )  # fmt: skip
    for title, settings in (
        ("reconstruction", ReconstructSettings), ("planting feet", PlantSettings),
    ):  # fmt: skip
        arguments_from(parser.add_argument_group(title), settings)


class Guides(NamedTuple):
    """Priors of a run; None for the shipped ones."""

    postures: PostureLibrary | None
    residuals: ResidualPrior | None


def read_guides(arguments: argparse.Namespace, progress: Progress) -> Guides:
    """Learn or read the priors, once for all files of a run."""
    check_library(arguments.library)
    given, library = arguments.residuals, arguments.postures
    residuals = None if given is None else load_residual_prior(given)
    if not arguments.train:
        return Guides(library and load_posture_library(library), residuals)
    clips = read_all(arguments.train, with_body(arguments, ""), within(progress, 0.0, 0.7))
    return Guides(
        posture_library_from_clips(clips, progress=within(progress, 0.7, 1.0)), residuals
    )


def perform_reconstruct(task: Task, prepared: Guides, progress: Progress) -> Outcome:
    """Reconstruct one recording, write it and report rebuilt joints and quality."""
    given, placed = read_on_floor(task.source, task.arguments, within(progress, 0.0, 0.1))
    guides, messages = _select_guides(given, task, prepared, within(progress, 0.1, 0.3))
    rebuilt = _rebuild(given, task, guides, within(progress, 0.3, 0.8))
    rebuilt = rebuilt._replace(remarks=(*placed, *messages, *rebuilt.remarks))
    assert task.target is not None
    if task.target.suffix.lower() != JOINTS:
        write(rebuilt.motion, task.target, within(progress, 0.9, 1.0))
    elif rebuilt.joints is None:
        raise InvalidMotionError(
            f"{task.source} has a skeleton, not joints; write it as {task.target.stem}.bvh."
        )
    else:
        write_joint_csv(rebuilt.joints, task.target, progress=within(progress, 0.9, 1.0))
    return _outcome(given, rebuilt)


def _select_guides(
    given: Any, task: Task, guides: Guides, progress: Progress
) -> tuple[Guides, tuple[str, ...]]:
    """Return the priors for one recording, from similar clips of a library if given."""
    if task.arguments.library is None:
        return guides, ()
    subject = given if isinstance(given, Motion) else _as_joints(given, task.source)
    found = collect_postures(subject, task.source, task.arguments, progress)
    return guides._replace(postures=found.postures), (found.message,)


def _rebuild(given: Any, task: Task, guides: Guides, progress: Progress) -> RebuiltTake:
    settings = settings_from_arguments(task.arguments, ReconstructSettings)
    feet = task.arguments.feet
    planting = settings_from_arguments(task.arguments, PlantSettings) if feet else None
    if isinstance(given, Motion):
        solution = reconstruct_motion(given, *guides, settings=settings, progress=progress)
        planting_result = plant_feet_if_possible(
            solution.motion, planting, reliability=solution.reliability
        )
        remarks = (*solution.remarks, *planting_result.remarks)
        slide = _slide(planting_result.planted)
        return RebuiltTake(
            planting_result.motion,
            None,
            solution.rebuilt_fraction,
            solution.method,
            remarks,
            slide,
        )
    recording = _as_joints(given, task.source)
    found = reconstruct_recording(
        recording,
        *guides,
        settings=settings,
        planting=planting,
        progress=progress,
    )
    rebuilt = found.reconstruction
    tracks = Tracks(
        rebuilt.tracks.names,
        rebuilt.tracks.positions,
        rebuilt.tracks.frame_rate,
        np.clip(rebuilt.confidence, 0.0, 1.0),
    )
    return RebuiltTake(
        found.motion,
        JointRecording(tracks, None, Sensor.OTHER),
        float(found.rebuilt.mean()),
        rebuilt.method,
        found.remarks,
        _slide(found.planted),
    )


def _slide(planted: Planted | None) -> tuple[float, float] | None:
    return None if planted is None else (planted.slide_before, planted.slide_after)


def _as_joints(given: JointRecording | Tracks, source: Path) -> JointRecording:
    """Return joints; points are interpreted as joints by their names."""
    if isinstance(given, JointRecording):
        return given
    if isinstance(given, Tracks):
        return JointRecording(given, None, Sensor.OTHER)
    raise InvalidMotionError(
        f"{source} holds depth images. Use capture; reconstruct is for joints."
    )


def _outcome(given: Any, rebuilt: RebuiltTake) -> Outcome:
    original = given.tracks if isinstance(given, JointRecording) else given
    before, after = measure_quality(original), measure_quality(rebuilt.motion)
    lines = [
        f"{100 * rebuilt.fraction:.1f} % of the joints were missing or wrong and were rebuilt."
    ]
    if method := rebuilt.method.rstrip("."):
        lines.append(f"{method[0].upper()}{method[1:]}.")
    if rebuilt.slide is not None:
        first, last = rebuilt.slide
        lines.append(
            f"The slide on the floor was {100 * first:.1f} cm before planting,"
            f" {100 * last:.1f} cm after."
        )
    lines += [*rebuilt.remarks, compare_quality(before, after)]
    figures = {
        "method": rebuilt.method,
        "rebuilt_share": rebuilt.fraction,
        "remarks": list(rebuilt.remarks),
        "slide_before_m": rebuilt.slide and rebuilt.slide[0],
        "slide_after_m": rebuilt.slide and rebuilt.slide[1],
        "before": before.figures(),
        "after": after.figures(),
    }
    return Outcome("\n".join(lines), figures)


RECONSTRUCT = VerbWork(add_reconstruct_options, perform_reconstruct, prepare=read_guides)
