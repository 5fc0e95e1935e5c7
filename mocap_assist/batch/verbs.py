"""The verbs of `blender FILE --command mocap_assist`: each does what a button does."""

import argparse
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, TypeVar, get_type_hints

import bpy

from ...solvers.command_line import arguments_from, settings_from_arguments
from ...solvers.progress import Progress
from ..check_choices import CheckSettings
from ..checking import read_checking, show_checked
from ..clean_choices import CleanSettings, Prior
from ..cleaning import read_cleaning, write_cleaned
from ..examples import SEPARATOR
from ..jobs.job import run
from ..scene import history

Bundle = TypeVar("Bundle", bound=NamedTuple)
Said = tuple[str, dict[str, Any]]


@dataclass(frozen=True)
class Verb:
    """A verb: its options, and what it does to an armature."""

    help: str
    add_options: Callable[[argparse.ArgumentParser], None]
    perform: Callable[[bpy.types.Scene, bpy.types.Object, argparse.Namespace, Progress], Said]
    writes: bool = True


def _clean_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--train", nargs="+", default=[], metavar="FILE",
        help="clean recordings to learn from; short for --prior examples --examples",
    )  # fmt: skip
    arguments_from(parser, *get_type_hints(CleanSettings).values())


def _clean(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    arguments: argparse.Namespace,
    progress: Progress,
) -> Said:
    settings = _bundle(arguments, CleanSettings)
    if arguments.train:
        choices = replace(
            settings.choices, prior=Prior.EXAMPLES, examples=SEPARATOR.join(arguments.train)
        )
        settings = settings._replace(choices=choices)
    cleaned = run(read_cleaning(scene, armature, settings), progress)
    sentence = write_cleaned(scene, armature, settings, cleaned)
    action, _ = history.played_result(armature)
    return sentence, {"action": action.name} | history.history(action)[-1]


def _check_options(parser: argparse.ArgumentParser) -> None:
    arguments_from(parser, *get_type_hints(CheckSettings).values())


def _check(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    arguments: argparse.Namespace,
    progress: Progress,
) -> Said:
    settings = _bundle(arguments, CheckSettings)
    checked = run(read_checking(scene, armature, settings), progress)
    sentence = show_checked(scene, armature, settings, checked)
    spots = [spot.sentence for spot in checked.spots]
    text = "\n".join([checked.quality.report(), "", sentence, *spots])
    return text, checked.quality.figures() | {"spots": spots}


def _bundle(arguments: argparse.Namespace, bundle: type[Bundle]) -> Bundle:
    classes = get_type_hints(bundle)
    return bundle(**{
        name: settings_from_arguments(arguments, each) for name, each in classes.items()
    })


VERBS = {
    "denoise": Verb(
        "Take jitter, spikes and gaps out of actions, and plant feet.", _clean_options, _clean
    ),
    "quality": Verb(
        "Measure jitter, spikes, gaps and sliding feet.", _check_options, _check, writes=False
    ),
}
"""A new verb is a new entry here."""
