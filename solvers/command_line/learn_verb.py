"""`learn`: learn filter bases from clean clips."""

import argparse
from pathlib import Path

from ..denoising import FilterBasesSettings, learn_filter_bases
from ..progress import Progress, within
from .arguments import (
    Outcome,
    Task,
    VerbWork,
    add_reading_options,
    arguments_from,
    read_all,
    settings_from_arguments,
)


def add_learn_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `learn`."""
    parser.add_argument(
        "--output", type=Path, required=True, metavar="FILE",
        help="The .npz file to write, for denoise --bases and the button Clean",
    )  # fmt: skip
    add_reading_options(parser)
    arguments_from(parser, FilterBasesSettings)


def perform_learn(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Learn filter bases from all clips, and save them."""
    settings = settings_from_arguments(task.arguments, FilterBasesSettings)
    clips = read_all(task.sources, task.arguments, within(progress, 0.0, 0.5))
    bases = learn_filter_bases(clips, settings=settings, progress=within(progress, 0.5, 1.0))
    assert task.target is not None
    bases.save(task.target)
    figures = {
        "n_clips": int(bases.n_clips),
        "n_patterns": len(bases.values),
        "window_frames": bases.window,
        "frame_rate_hz": float(bases.frame_rate),
        "parts": [str(key) for key in bases.keys],
    }
    clips_text = "1 clip" if len(clips) == 1 else f"{len(clips)} clips"
    text = f"Learned {len(bases.values)} patterns from {clips_text} into {task.target}."
    return Outcome(text, figures)


LEARN = VerbWork(add_learn_options, perform_learn)
