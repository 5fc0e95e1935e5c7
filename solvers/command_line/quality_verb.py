"""`quality`: measure jitter, spikes, gaps and foot slide."""

import argparse

from ..denoising import QualitySettings, measure_quality
from ..progress import Progress, within
from .arguments import (
    Outcome,
    Task,
    VerbWork,
    add_reading_options,
    arguments_from,
    read,
    settings_from_arguments,
)


def add_quality_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `quality`."""
    add_reading_options(parser)
    arguments_from(parser, QualitySettings)


def perform_quality(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Measure one recording."""
    recording = read(task.source, task.arguments, within(progress, 0.0, 0.5))
    settings = settings_from_arguments(task.arguments, QualitySettings)
    quality = measure_quality(recording, settings=settings, progress=within(progress, 0.5, 1.0))
    return Outcome(quality.report(), quality.figures())


QUALITY = VerbWork(add_quality_options, perform_quality)
