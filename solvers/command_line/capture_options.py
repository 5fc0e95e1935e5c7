"""The options of `capture`, and which of them go together."""

import argparse
import re
from collections.abc import Collection
from pathlib import Path

from ..denoising import PlantSettings
from ..depth_scene import ForegroundSettings
from ..depth_tracking.body import BodyModel, load_body_model
from ..depth_tracking.capturing import CaptureMethod, CaptureSettings, check_default_method
from ..depth_tracking.several_cameras import AlignmentSettings
from ..errors import InvalidSettingError
from ..progress import Progress
from ..recordings import depth_takes_in
from ..recordings.depth_files import DepthSettings
from .arguments import arguments_from, find_recordings
from .batches import take_of_person
from .follow_recording import add_follow_options, check_follow
from .unused_options import check_unused_options

ALL = "all"
"""Of `--people`: as many as are visible at once."""


def add_capture_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `capture`."""
    parser.add_argument(
        "--body", type=Path, metavar="FILE",
        help="Body of the actor, written by --keep-body [default: fitted to the recording]",
    )  # fmt: skip
    parser.add_argument(
        "--keep-body", type=Path, metavar="FILE", help="Also write the fitted body"
    )
    parser.add_argument(
        "--people", type=parse_people, default=1, metavar="N",
        help="Number of people to track together, or all for as many as are visible at once."
        " Of take.bvh, the second person is written to take_person2.bvh, and so on [default 1:"
        " the most visible person]",
    )  # fmt: skip
    parser.add_argument(
        "--camera", type=Path, metavar="FILE", action="append", default=[],
        help="Recording of the same take by another depth camera; its place and time are found"
        " by the actor. Repeat it for more cameras",
    )  # fmt: skip
    parser.add_argument(
        "--empty", nargs=2, type=int, metavar=("FIRST", "LAST"),
        help="Frames of the empty room, for background subtraction",
    )  # fmt: skip
    parser.add_argument(
        "--joints", action="store_true",
        help="With --output-folder: write joints with confidence as .csv, in camera space,"
        " instead of the motion of a skeleton",
    )  # fmt: skip
    parser.add_argument(
        "--feet", action=argparse.BooleanOptionalAction, default=True,
        help="Plant standing feet [default: yes, where they are visible]",
    )  # fmt: skip
    add_follow_options(parser)
    for title, settings in (
        ("reading", DepthSettings), ("the actor", ForegroundSettings),
        ("tracking", CaptureSettings), ("several cameras", AlignmentSettings),
        ("planting feet", PlantSettings),
    ):  # fmt: skip
        arguments_from(parser.add_argument_group(title), settings)


def parse_people(word: str) -> int:
    """Return a number of people for argparse; 0 is all."""
    if word == ALL:
        return 0
    if re.fullmatch(r"[1-9]\d?", word, re.ASCII) is None:
        raise argparse.ArgumentTypeError(
            f"{word!r} is no number of people; write a number from 1 to 99, or {ALL}"
        )
    return int(word)


def read_body(arguments: argparse.Namespace, progress: Progress) -> BodyModel | None:
    """Read the body for all files of a run, if one is given.

    Raises
    ------
    InvalidSettingError
        --keep-body or --body is combined with several people, --keep-body or --camera with
        several takes, --camera with several people, or --follow with any of these; an option
        would have no effect, or a published method is to track more than it can.
    """
    check_follow(arguments)
    check_unused_options(arguments)
    _check_people(arguments)
    _check_cameras(arguments)
    takes = []
    if arguments.output_folder is not None:
        takes = find_recordings(arguments.files, list_recordings=depth_takes_in)
    if arguments.people != 1:
        _check_names({relative.with_suffix("") for _, relative in takes})
    if arguments.keep_body is not None and len(takes) > 1:
        raise InvalidSettingError(
            f"{arguments.keep_body} can hold one body. Capture one take with --keep-body,"
            " and the others with --body."
        )
    return None if arguments.body is None else load_body_model(arguments.body)


def _check_people(arguments: argparse.Namespace) -> None:
    """Raise InvalidSettingError if several people, cameras or images to come are too many."""
    if arguments.people != 1 or arguments.camera or arguments.follow:
        check_default_method(getattr(arguments, "method", CaptureMethod.DEFAULT))
    if arguments.people != 1 and (arguments.body or arguments.keep_body) is not None:
        raise InvalidSettingError(
            "A body file holds one body. Leave out --body and --keep-body with --people."
        )
    if arguments.camera and arguments.people != 1:
        raise InvalidSettingError(
            "Several cameras track one person. Leave out --people or --camera."
        )


def _check_cameras(arguments: argparse.Namespace) -> None:
    """Raise InvalidSettingError if the cameras are not those of one take."""
    cameras = [path.resolve() for path in (*arguments.files[:1], *arguments.camera)]
    if len({*cameras}) < len(cameras):
        raise InvalidSettingError(
            "The same recording is given for two cameras. Name another one after --camera."
        )
    if arguments.camera and arguments.output_folder is not None:
        raise InvalidSettingError(
            "--camera adds a recording to one take. Name one file to read and one to write."
        )


def _check_names(names: Collection[Path]) -> None:
    """Raise InvalidSettingError where a person of one take would be written as another take."""
    for name in names:
        take = take_of_person(name.name)
        if take is not None and name.with_name(take) in names:
            raise InvalidSettingError(
                f"{name} and a person of {take} would be written to one file. Rename one of"
                " the recordings."
            )
