"""Refuse options of `capture` that would have no effect."""

import argparse
from collections.abc import Collection, Iterator
from dataclasses import fields
from typing import NamedTuple

from ..denoising import PlantSettings
from ..depth_tracking.capturing import CaptureMethod
from ..depth_tracking.several_cameras import AlignmentSettings
from ..errors import InvalidSettingError
from ..settings import Settings
from ..workflows.following import FollowSettings

OF_LATER_IMAGES = ("backward", "smoothing")
"""Settings that need the images after the one that is tracked."""


class _Condition(NamedTuple):
    """Options, whether they have an effect, and what decides that."""

    names: Collection[str]
    is_used: bool
    reason: str


def check_unused_options(arguments: argparse.Namespace) -> None:
    """Raise InvalidSettingError if an option is given that would be ignored."""
    for names, is_used, reason in _conditions(arguments):
        given = [name for name in names if hasattr(arguments, name)]
        if given and not is_used:
            no = "no-" if getattr(arguments, given[0]) is False else ""
            option = f"--{no}{given[0].replace('_', '-')}"
            raise InvalidSettingError(f"{option} has no effect {reason}. Leave it out.")
    if arguments.joints and arguments.output_folder is None:
        raise InvalidSettingError(
            "--joints has no effect without --output-folder. To write joints, end the name of"
            " the file in .csv."
        )


def _conditions(arguments: argparse.Namespace) -> Iterator[_Condition]:
    yield _Condition(_names(FollowSettings), arguments.follow, "without --follow")
    yield _Condition(_names(AlignmentSettings), bool(arguments.camera), "without --camera")
    yield _Condition(_names(PlantSettings), arguments.feet, "with --no-feet")
    later = [name for name in OF_LATER_IMAGES if getattr(arguments, name, False)]
    yield _Condition(later, not arguments.follow, "with --follow")
    method = getattr(arguments, "method", CaptureMethod.DEFAULT)
    yield _Condition(later, method is CaptureMethod.DEFAULT, f"with --method {method.value}")


def _names(settings: type[Settings]) -> list[str]:
    return [item.name for item in fields(settings)]
