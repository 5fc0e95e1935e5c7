"""`reconstruct`: clean poses from what a depth camera's tracker saw."""

import argparse
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..denoising import Planted, PlantSettings, compare_quality, measure_quality
from ..errors import InvalidMotionError
from ..motion import JointRecording, Motion, Sensor, Tracks
from ..progress import Progress, overheard, within
from ..reconstruction import (
    PostureLibrary,
    ReconstructSettings,
    ResidualPrior,
    load_posture_library,
    load_residual_prior,
)
from ..recordings import read_tracked, write_joint_csv
from ..workflows import (
    plant_feet_if_possible,
    posture_library_from_clips,
    reconstruct_motion,
    reconstruct_recording,
)
from .files import JOINTS, add_reading_options, read_all, write
from .from_library import add_library_option, check_library, postures_for
from .options import arguments_from, settings_from_arguments
from .verb import Outcome, Task


class Rebuilt(NamedTuple):
    """What came of one recording, whatever it was."""

    motion: Motion
    joints: JointRecording | None
    share: float
    """Of the joints and frames that were rebuilt."""
    method: str
    remarks: tuple[str, ...]
    slide: tuple[float, float] | None
    """Metres that the feet slid before and after they were planted."""


def add_reconstruct_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `reconstruct`."""
    add_reading_options(parser)
    postures = parser.add_mutually_exclusive_group()
    add_library_option(postures)
    postures.add_argument(
        "--train", nargs="+", type=Path, default=[], metavar="FILE",
        help="Clean clips of skeletons, or folders of them, to learn postures from; without"
        " them those that come with Mocap Assist guide",
    )  # fmt: skip
    postures.add_argument(
        "--postures", type=Path, metavar="FILE",
        help="Postures of your own, as learn-postures wrote them, in their place",
    )  # fmt: skip
    parser.add_argument(
        "--residuals", type=Path, metavar="FILE",
        help="How the sensor errs, as learn-residuals wrote it; without it a Kinect v2's",
    )  # fmt: skip
    parser.add_argument(
        "--joints", action="store_true",
        help="With --output-folder: write joints as .csv, with the confidence of each, in the"
        " place of a skeleton's motion",
    )  # fmt: skip
    parser.add_argument(
        "--feet", action=argparse.BooleanOptionalAction, default=True,
        help="Whether to keep standing feet from sliding [default: yes, where there are feet]",
    )  # fmt: skip
    for title, settings in (
        ("reconstruction", ReconstructSettings), ("planting feet", PlantSettings),
    ):  # fmt: skip
        arguments_from(parser.add_argument_group(title), settings)


class Guides(NamedTuple):
    """What guides a run; None for what is shipped."""

    postures: PostureLibrary | None
    residuals: ResidualPrior | None


def read_guides(arguments: argparse.Namespace, progress: Progress) -> Guides:
    """Learn and read, once for all files of a run, what guides them."""
    check_library(arguments.library)
    given, library = arguments.residuals, arguments.postures
    residuals = None if given is None else load_residual_prior(given)
    if not arguments.train:
        return Guides(library and load_posture_library(library), residuals)
    clips = read_all(arguments.train, arguments, within(progress, 0.0, 0.7))
    return Guides(
        posture_library_from_clips(clips, progress=within(progress, 0.7, 1.0)), residuals
    )


def perform_reconstruct(task: Task, prepared: Guides, progress: Progress) -> Outcome:
    """Reconstruct one recording and write it; tell what was lost, and the quality."""
    told: list[str] = []
    listening = overheard(within(progress, 0.0, 0.1), told)
    given = read_tracked(task.source, scale=task.arguments.scale, progress=listening)
    guides, said = _guides_for(given, task, prepared, within(progress, 0.1, 0.3))
    rebuilt = _rebuilt(given, task, guides, within(progress, 0.3, 0.8))
    rebuilt = rebuilt._replace(remarks=(*(f"{one}." for one in told), *said, *rebuilt.remarks))
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


def _guides_for(
    given: Any, task: Task, guides: Guides, progress: Progress
) -> tuple[Guides, tuple[str, ...]]:
    """Return what guides one recording; what is like it in a library, where there is one."""
    if task.arguments.library is None:
        return guides, ()
    subject = given if isinstance(given, Motion) else _joints_of(given, task.source)
    found = postures_for(subject, task.source, task.arguments, progress)
    return guides._replace(postures=found.postures), (found.message,)


def _rebuilt(given: Any, task: Task, guides: Guides, progress: Progress) -> Rebuilt:
    settings = settings_from_arguments(task.arguments, ReconstructSettings)
    feet = task.arguments.feet
    planting = settings_from_arguments(task.arguments, PlantSettings) if feet else None
    if isinstance(given, Motion):
        whole = reconstruct_motion(given, *guides, settings=settings, progress=progress)
        footing = plant_feet_if_possible(whole.motion, planting, reliability=whole.reliability)
        remarks = (*whole.remarks, *footing.remarks)
        slide = _slide(footing.planted)
        return Rebuilt(
            footing.motion, None, whole.rebuilt_fraction, whole.method, remarks, slide
        )
    recording = _joints_of(given, task.source)
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
    return Rebuilt(
        found.motion,
        JointRecording(tracks, None, Sensor.OTHER),
        float(found.rebuilt.mean()),
        rebuilt.method,
        found.remarks,
        _slide(found.planted),
    )


def _slide(planted: Planted | None) -> tuple[float, float] | None:
    return None if planted is None else (planted.slide_before, planted.slide_after)


def _joints_of(given: JointRecording | Tracks, source: Path) -> JointRecording:
    """Return joints; points are taken for them where their names say so."""
    if isinstance(given, JointRecording):
        return given
    if isinstance(given, Tracks):
        return JointRecording(given, None, Sensor.OTHER)
    raise InvalidMotionError(f"{source} holds depth pictures; reconstruct is for joints.")


def _outcome(given: Any, rebuilt: Rebuilt) -> Outcome:
    before_of = given.tracks if isinstance(given, JointRecording) else given
    before, after = measure_quality(before_of), measure_quality(rebuilt.motion)
    lines = [f"{100 * rebuilt.share:.1f} % of the joints were lost or wrong, and are rebuilt."]
    if method := rebuilt.method.rstrip("."):
        lines.append(f"{method[0].upper()}{method[1:]}.")
    if rebuilt.slide is not None:
        first, last = rebuilt.slide
        lines.append(f"Feet slid {100 * first:.1f} cm in all, and {100 * last:.1f} cm now.")
    lines += [*rebuilt.remarks, compare_quality(before, after)]
    figures = {
        "method": rebuilt.method,
        "rebuilt_share": rebuilt.share,
        "remarks": list(rebuilt.remarks),
        "slide_before_m": rebuilt.slide and rebuilt.slide[0],
        "slide_after_m": rebuilt.slide and rebuilt.slide[1],
        "before": before.figures(),
        "after": after.figures(),
    }
    return Outcome("\n".join(lines), figures)
