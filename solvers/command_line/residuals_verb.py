"""`learn-residuals`: learn the errors of a sensor from takes with a reference."""

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from ..errors import InvalidFileError, InvalidMotionError, InvalidSettingError
from ..motion import JointRecording, Motion, Tracks, resample
from ..motion.humanoid import POSTURE_JOINTS, postures_from_motion
from ..progress import Progress, within
from ..reconstruction import ResidualPriorSettings, learn_residual_prior
from ..reconstruction.residual_correction import calibrate_confidence
from ..recordings import read_tracked, recordings_in
from .arguments import Outcome, Task, VerbWork, arguments_from, settings_from_arguments


def add_residuals_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `learn-residuals`."""
    parser.add_argument(
        "--truth", type=Path, required=True, metavar="FOLDER",
        help="Folder with the same takes recorded by a reference system, under the same names:"
        " motions (BVH, AMC) or joints, in the same world space and time",
    )  # fmt: skip
    parser.add_argument(
        "--actors", nargs="+", metavar="NAME",
        help="Prefixes of the file names that identify the actor, such as anna bob"
        " [default: every take is of another actor]",
    )  # fmt: skip
    parser.add_argument(
        "--confidence", action="store_true",
        help="Also calibrate the confidence for unknown actors, by cross-validation over at"
        " least three --actors; multiplies the run time by about their number",
    )  # fmt: skip
    parser.add_argument(
        "--output", type=Path, required=True, metavar="FILE",
        help="The .npz file to write, for reconstruct --residuals",
    )  # fmt: skip
    parser.add_argument(
        "--scale", type=float, metavar="X",
        help="Meters per unit of the sensor's files [default: as stored in the file]",
    )  # fmt: skip
    arguments_from(parser, ResidualPriorSettings)


def perform_residuals(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Learn a residual prior from pairs of takes, and write it."""
    arguments = task.arguments
    if arguments.confidence and arguments.actors is None:
        raise InvalidSettingError(
            "--confidence needs --actors: cross-validation leaves one actor out at a time."
        )
    pairs = list(_pairs(task.sources, arguments, within(progress, 0.0, 0.4)))
    names = [path.stem for path in task.sources]
    actors = [str(path) for path in task.sources]
    if arguments.actors is not None:
        actors = _actors(names, arguments.actors)
    settings = settings_from_arguments(arguments, ResidualPriorSettings)
    prior = learn_residual_prior(
        pairs, actors=actors, settings=settings, progress=within(progress, 0.4, 0.6)
    )
    if arguments.confidence:
        prior = calibrate_confidence(
            prior, pairs, actors, settings=settings, progress=within(progress, 0.6, 1.0)
        )
    assert task.target is not None
    prior.save(task.target)
    text = f"Learned how {len(prior.joints)} joints err from {prior.source} into {task.target}."
    return Outcome(text, {"joints": list(map(str, prior.joints)), "n_takes": len(pairs)})


def _pairs(
    sources: Sequence[Path], arguments: argparse.Namespace, progress: Progress
) -> Iterator[tuple[JointRecording, Tracks]]:
    partners = {path.stem: path for path in recordings_in(arguments.truth)}
    for number, path in enumerate(sources):
        progress(number / len(sources), f"Reading {path.name}")
        if path.stem not in partners:
            raise InvalidFileError(
                f"{arguments.truth} has no reference take for {path}; name it {path.stem}."
            )
        measured = read_tracked(path, scale=arguments.scale)
        if not isinstance(measured, JointRecording):
            raise InvalidMotionError(f"{path} holds no joints of a depth camera.")
        reference = _joints(read_tracked(partners[path.stem]), partners[path.stem])
        reference = resample(reference, measured.frame_rate)
        n_frames = min(measured.n_frames, reference.n_frames)
        yield measured.slice(0, n_frames), reference.slice(0, n_frames)


def _joints(reference: Any, path: Path) -> Tracks:
    """Return the joints of a reference take."""
    if isinstance(reference, Motion):
        return Tracks(POSTURE_JOINTS, postures_from_motion(reference), reference.frame_rate)
    if isinstance(reference, JointRecording):
        return reference.tracks
    raise InvalidMotionError(
        f"{path} holds markers; solve a skeleton from them first, with the verb solve."
    )


def _actors(names: Sequence[str], prefixes: Sequence[str]) -> list[str]:
    found = []
    for name in names:
        matching = [prefix for prefix in prefixes if name.startswith(prefix)]
        if not matching:
            raise InvalidMotionError(
                f"{name} does not start with the name of an actor: {', '.join(prefixes)}."
            )
        found.append(max(matching, key=len))
    return found


LEARN_RESIDUALS = VerbWork(add_residuals_options, perform_residuals)
