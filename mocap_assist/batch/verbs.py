"""The verbs of `blender FILE --command mocap_assist`, one for each button."""

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import bpy

from ...solvers.command_line.arguments import (
    MOTIONS,
    POINTS_BY_DEFAULT,
    add_preset_option,
    check_target,
    convert,
)
from ...solvers.errors import InvalidSettingError
from ...solvers.progress import Progress
from ..actions.armature_read import read_take
from ..actions.markers.take import read_markers
from ..blender.name_lists import join_names
from ..check.button_settings import CheckBundle
from ..check.scene_checking import read_checking, show_checked
from ..clean.button_settings import CleanBundle, Prior
from ..clean.scene_cleaning import read_cleaning, write_cleaned
from ..runtime.selection import played_source
from ..scene import history
from .bundles import add_bundle_options, bundle_from_arguments
from .export_verb import HELP as EXPORT_HELP
from .export_verb import add_export_options, check_export, perform_export
from .fix_verb import add_fix_options, perform_fix
from .library_verbs import FIND_HELP, add_find_options, check_find, perform_find
from .reconstruct_verb import add_reconstruct_options, perform_reconstruct
from .retarget_verbs import (
    add_retarget_options,
    add_unbake_options,
    perform_retarget,
    perform_unbake,
    retarget_target,
)
from .simulate_verb import add_simulate_options, perform_simulate
from .solving import solve_in_subprocess
from .vary_verb import HELP as VARY_HELP
from .vary_verb import add_vary_options, perform_vary

VerbResult = tuple[str, dict[str, Any]]


def check_nothing(arguments: argparse.Namespace, armatures: Sequence[bpy.types.Object]) -> None:
    """Check nothing."""


def no_armature(arguments: argparse.Namespace) -> str:
    """Return no name of an armature."""
    return ""


@dataclass(frozen=True)
class SceneVerb:
    """A verb: its options, and its work on an armature."""

    help: str
    add_options: Callable[[argparse.ArgumentParser], None]
    perform: Callable[
        [bpy.types.Scene, bpy.types.Object, argparse.Namespace, Progress], VerbResult
    ]
    writes: bool = True
    """Whether it changes the .blend file, which is then saved."""
    check: Callable[[argparse.Namespace, Sequence[bpy.types.Object]], None] = check_nothing
    """Raise a MocapAssistError before the work if its result cannot be written."""
    excluded_armature: Callable[[argparse.Namespace], str] = no_armature
    """Name of an armature to skip."""
    on_markers: bool = True
    """Whether it also works on the markers below an empty."""
    on_depth: bool = False
    """Whether it also works on the points of an imported depth recording."""
    solves: bool = True
    """Whether it solves, and has the option --threads."""


def _clean_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--train", nargs="+", default=[], metavar="FILE",
        help="clean recordings to learn from (same as --prior examples --examples)",
    )  # fmt: skip
    parser.add_argument(
        "--library", metavar="FILE",
        help="clip library; learn from its clips most similar to the take (same as --prior"
        " library)",
    )  # fmt: skip
    add_preset_option(parser, "denoise")
    add_bundle_options(parser, CleanBundle)


def _clean(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    arguments: argparse.Namespace,
    progress: Progress,
) -> VerbResult:
    settings = bundle_from_arguments(arguments, CleanBundle)
    if arguments.train:
        choices = replace(
            settings.choices, prior=Prior.EXAMPLES, examples=join_names(arguments.train)
        )
        settings = settings._replace(choices=choices)
    elif arguments.library:
        scene.mocap_assist.library.library_file = arguments.library
        settings = settings._replace(choices=replace(settings.choices, prior=Prior.LIBRARY))
    cleaned = solve_in_subprocess(read_cleaning(scene, armature, settings), arguments, progress)
    sentence = write_cleaned(scene, armature, settings, cleaned)
    action, _ = played_source(armature)
    return sentence, {"action": action.name, **history.history(action)[-1]}


def _check_options(parser: argparse.ArgumentParser) -> None:
    add_bundle_options(parser, CheckBundle)


def _check(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    arguments: argparse.Namespace,
    progress: Progress,
) -> VerbResult:
    settings = bundle_from_arguments(arguments, CheckBundle)
    checked = solve_in_subprocess(read_checking(scene, armature, settings), arguments, progress)
    sentence = show_checked(scene, armature, settings, checked)
    issues = [issue.sentence for issue in checked.issues]
    text = "\n".join([scene.mocap_assist.report, "", sentence, *issues])
    return text, checked.quality.figures() | {"spots": issues}


def _convert_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "target", type=Path, metavar="OUT",
        help=f"file to write, such as walk{MOTIONS}; or an existing folder, for one file named"
        " after each armature",
    )  # fmt: skip


def _check_targets(
    arguments: argparse.Namespace, armatures: Sequence[bpy.types.Object]
) -> None:
    targets = [_target(arguments, armature) for armature in armatures]
    if len(set(targets)) < len(targets):
        named = ", ".join(armature.name for armature in armatures)
        raise InvalidSettingError(
            f"{named} cannot all be written to {targets[0]}. Name one with --armature, or a"
            " folder to write to."
        )
    for target in targets:
        check_target(target)


def _target(arguments: argparse.Namespace, armature: bpy.types.Object) -> Path:
    """Return the file to write: in a folder, one with the armature's name."""
    target: Path = arguments.target
    if target.is_dir():
        ending = MOTIONS if armature.type == "ARMATURE" else POINTS_BY_DEFAULT
        target /= bpy.path.clean_name(armature.name) + ending
    return target


def _convert(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    arguments: argparse.Namespace,
    progress: Progress,
) -> VerbResult:
    """Write the current motion of the armature, raw or clean."""
    target = _target(arguments, armature)
    if armature.type == "ARMATURE":
        take = read_take(armature, scene, source=played_source(armature))
        outcome = convert(take.parts[0].motion, target, progress)
    else:
        outcome = convert(read_markers(armature, scene).tracks, target, progress)
    return f"{target}: {outcome.text}", {"output": str(target)} | outcome.figures


VERBS = {
    "fix": SceneVerb(
        "Fix takes of any origin by what suits them: track, clean, solve or reconstruct.",
        add_fix_options,
        perform_fix,
        on_depth=True,
    ),
    "denoise": SceneVerb(
        "Remove jitter and spikes from actions, fill gaps and plant feet.",
        _clean_options,
        _clean,
    ),
    "quality": SceneVerb(
        "Measure jitter, spikes, gaps and sliding feet.", _check_options, _check, writes=False
    ),
    "convert": SceneVerb(
        "Export the current actions of armatures, raw or clean, as BVH in centimeters, Y up;"
        " markers as TRC.",
        _convert_options,
        _convert,
        writes=False,
        check=_check_targets,
        solves=False,
    ),
    "export": SceneVerb(
        EXPORT_HELP,
        add_export_options,
        perform_export,
        writes=False,
        check=check_export,
        on_markers=False,
    ),
    "reconstruct": SceneVerb(
        "Rebuild missing and wrong joints of depth camera takes, and plant feet.",
        add_reconstruct_options,
        perform_reconstruct,
        on_markers=False,
    ),
    "simulate": SceneVerb(
        "Simulate a body with mass that follows the motions of armatures.",
        add_simulate_options,
        perform_simulate,
        on_markers=False,
    ),
    "retarget": SceneVerb(
        "Transfer the motions of an armature to another one.",
        add_retarget_options,
        perform_retarget,
        excluded_armature=retarget_target,
        on_markers=False,
    ),
    "unbake": SceneVerb(
        "Replace a key on every frame with a few keys with handles.",
        add_unbake_options,
        perform_unbake,
        on_markers=False,
    ),
    "vary": SceneVerb(VARY_HELP, add_vary_options, perform_vary, on_markers=False),
    "find": SceneVerb(
        FIND_HELP, add_find_options, perform_find, writes=False, check=check_find
    ),
}
"""A new verb is a new entry here."""
