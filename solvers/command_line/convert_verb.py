"""`convert`: write recordings of any known format as BVH, C3D or TRC."""

import argparse

from ..progress import Progress, within
from ..recordings import FloorPlacementSettings
from .arguments import (
    Outcome,
    Task,
    VerbWork,
    add_reading_options,
    arguments_from,
    convert,
    read,
    settings_from_arguments,
)


def add_convert_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `convert`."""
    add_reading_options(parser)
    arguments_from(parser, FloorPlacementSettings)


def perform_convert(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Read one recording and write it in another format."""
    reading = within(progress, 0.0, 0.7)
    floor = settings_from_arguments(task.arguments, FloorPlacementSettings).place_on_floor
    recording = read(task.source, task.arguments, reading, floor)
    return convert(recording, task.target, within(progress, 0.7, 1.0))


CONVERT = VerbWork(add_convert_options, perform_convert)
