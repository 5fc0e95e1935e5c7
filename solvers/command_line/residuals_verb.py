"""`learn-residuals`: how a sensor errs, from takes that another system saw as well."""

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
from .options import arguments_from, settings_from_arguments
from .verb import Outcome, Task


def add_residuals_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `learn-residuals`."""
    parser.add_argument(
        "--truth", type=Path, required=True, metavar="FOLDER",
        help="A folder with the same takes as the other system saw them, under the same names:"
        " skeletons' motions (BVH, AMC) or joints, in the same world and at the same times",
    )  # fmt: skip
    parser.add_argument(
        "--actors", nargs="+", metavar="NAME",
        help="Beginnings of the files' names that tell who was recorded, such as anna bob;"
        " without them every take counts as another actor",
    )  # fmt: skip
    parser.add_argument(
        "--confidence", action="store_true",
        help="Also learn how far the result is to be believed of people whom it never saw, by"
        " leaving each of at least three --actors out; takes about as many times as long",
    )  # fmt: skip
    parser.add_argument(
        "--output", type=Path, required=True, metavar="FILE",
        help="The .npz file to write; reconstruct --residuals reads it",
    )  # fmt: skip
    parser.add_argument(
        "--scale", type=float, metavar="X",
        help="Metres in one unit of the sensor's files [default: as the file says]",
    )  # fmt: skip
    arguments_from(parser, ResidualPriorSettings)


def perform_residuals(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Learn from all takes that have a partner, and write what was learned."""
    arguments = task.arguments
    if arguments.confidence and arguments.actors is None:
        raise InvalidSettingError(
            "--confidence needs --actors: it leaves people out, and must know whose takes are"
            " whose."
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
    for place, path in enumerate(sources):
        progress(place / len(sources), f"Reading {path.name}")
        if path.stem not in partners:
            raise InvalidFileError(
                f"{arguments.truth} has no take named {path.stem}, as {path} is."
            )
        seen = read_tracked(path, scale=arguments.scale)
        if not isinstance(seen, JointRecording):
            raise InvalidMotionError(f"{path} holds no joints of a depth camera.")
        true = _joints(read_tracked(partners[path.stem]), partners[path.stem])
        true = resample(true, seen.frame_rate)
        n_frames = min(seen.n_frames, true.n_frames)
        yield seen.slice(0, n_frames), true.slice(0, n_frames)


def _joints(true: Any, path: Path) -> Tracks:
    """Return the joints of a take of the other system."""
    if isinstance(true, Motion):
        return Tracks(POSTURE_JOINTS, postures_from_motion(true), true.frame_rate)
    if isinstance(true, JointRecording):
        return true.tracks
    raise InvalidMotionError(
        f"{path} holds markers; solve a skeleton from them first (python -m solvers solve)."
    )


def _actors(names: Sequence[str], beginnings: Sequence[str]) -> list[str]:
    found = []
    for name in names:
        known = [one for one in beginnings if name.startswith(one)]
        if not known:
            raise InvalidMotionError(
                f"{name} begins with none of the actors' names: {', '.join(beginnings)}."
            )
        found.append(max(known, key=len))
    return found
