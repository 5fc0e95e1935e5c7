"""`capture --follow`: track depth images while a recorder writes them."""

import argparse
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Event

from ..denoising import PlantSettings
from ..depth_scene import ForegroundSettings
from ..depth_tracking.body import BodyModel
from ..depth_tracking.capturing import CaptureSettings
from ..errors import InvalidSettingError
from ..progress import Progress
from ..recordings.depth_files import DepthSettings
from ..recordings.growing import open_growing
from ..workflows.following import (
    DetectorProcess,
    FollowedMotion,
    FollowSettings,
    follow_depth,
)
from .arguments import arguments_from, settings_from_arguments

ENDING_SIGNALS = (signal.SIGINT, signal.SIGTERM)


def add_follow_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `capture --follow`."""
    parser.add_argument(
        "--follow", action="store_true",
        help="Track a folder of images or an .mkv live, while a recorder writes it, and write"
        " the motion at the end: on Ctrl+C, or when no image comes any more",
    )  # fmt: skip
    arguments_from(parser.add_argument_group("following"), FollowSettings)


def check_follow(arguments: argparse.Namespace) -> None:
    """Raise InvalidSettingError if several recordings or people are to be followed."""
    if arguments.follow and arguments.output_folder is not None:
        raise InvalidSettingError(
            "One recording can be followed at a time: name its folder and the file to write,"
            " without --output-folder."
        )
    if arguments.follow and (arguments.camera or arguments.people != 1):
        raise InvalidSettingError(
            "--follow tracks one person before one camera. Leave out --camera and --people."
        )


def follow_recording(
    source: Path, arguments: argparse.Namespace, body: BodyModel | None, progress: Progress
) -> FollowedMotion:
    """Track a recording until it ends or Ctrl+C is pressed."""
    growing = open_growing(source, settings_from_arguments(arguments, DepthSettings))
    first, last = arguments.empty or (0, -1)
    planting = settings_from_arguments(arguments, PlantSettings) if arguments.feet else None
    with end_on_signal() as is_ended, DetectorProcess() as detector:
        return follow_depth(
            growing,
            detector,
            body,
            empty=range(first, last + 1),
            settings=settings_from_arguments(arguments, FollowSettings),
            capture=settings_from_arguments(arguments, CaptureSettings),
            foreground=settings_from_arguments(arguments, ForegroundSettings),
            planting=planting,
            is_ended=is_ended,
            progress=progress,
        )


@contextmanager
def end_on_signal() -> Iterator[Callable[[], bool]]:
    """Yield a function that returns whether Ctrl+C was pressed; a second press interrupts."""
    ended = Event()
    before = {each: signal.getsignal(each) for each in ENDING_SIGNALS}

    def restore() -> None:
        for each, handler in before.items():
            signal.signal(each, handler)

    def end(number: int, frame: object) -> None:
        ended.set()
        restore()

    for each in ENDING_SIGNALS:
        signal.signal(each, end)
    try:
        yield ended.is_set
    finally:
        restore()
