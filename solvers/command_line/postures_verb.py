"""`learn-postures`: build a posture library from clean clips."""

import argparse
from pathlib import Path

from ..progress import Progress, within
from ..reconstruction import PostureLibrarySettings
from ..workflows import posture_library_from_clips
from .arguments import (
    Outcome,
    Task,
    VerbWork,
    add_reading_options,
    arguments_from,
    read_all,
    settings_from_arguments,
)


def add_postures_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `learn-postures`."""
    parser.add_argument(
        "--output", type=Path, required=True, metavar="FILE",
        help="The .npz file to write, for reconstruct --postures and the button Reconstruct",
    )  # fmt: skip
    add_reading_options(parser)
    arguments_from(parser, PostureLibrarySettings)


def perform_postures(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Collect the postures of all clips and write the most distinct ones."""
    clips = read_all(task.sources, task.arguments, within(progress, 0.0, 0.5))
    library = posture_library_from_clips(
        clips,
        settings=settings_from_arguments(task.arguments, PostureLibrarySettings),
        progress=within(progress, 0.5, 1.0),
    )
    assert task.target is not None
    library.save(task.target)
    text = (
        f"Kept {library.n_postures} of {library.n_seen} postures of {library.trained_on} in"
        f" {task.target}."
    )
    figures = {"n_postures": library.n_postures, "n_seen": library.n_seen}
    return Outcome(text, figures)


LEARN_POSTURES = VerbWork(add_postures_options, perform_postures)
