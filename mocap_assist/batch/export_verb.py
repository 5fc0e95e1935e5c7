"""The verb `export`: what the button Export Clean Take does."""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import bpy

from ...solvers.command_line.arguments import arguments_from, settings_from_arguments
from ...solvers.errors import InvalidSettingError
from ...solvers.files import real_path
from ...solvers.progress import Progress
from ..exporting.button_settings import ExportBundle, ExportChoices, ExportFile
from ..exporting.scene_exporting import read_export, write_exported
from ..exporting.target_file import ENDINGS, target_of
from .solving import solve_in_subprocess

HELP = (
    "Export the current actions of armatures, raw or clean, as FBX, GLB or BVH at the scene's"
    " rate."
)
VerbResult = tuple[str, dict[str, Any]]


def add_export_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `export`; those of the button, and the file."""
    parser.add_argument(
        "target", type=Path, metavar="OUT",
        help="file to write, such as walk.fbx, walk.glb or walk.bvh; or an existing folder,"
        " for one file named after each armature",
    )  # fmt: skip
    arguments_from(parser, ExportChoices)


def check_export(arguments: argparse.Namespace, armatures: Sequence[bpy.types.Object]) -> None:
    """Raise an error, before any work, if a file cannot be written or is written twice."""
    given = real_path(arguments.target)
    if not given.is_dir() and given.suffix.lower() not in ENDINGS:
        raise InvalidSettingError(
            f"{given} cannot be written; end the name in {' or '.join(ENDINGS)}."
        )
    bundles = [_bundle(arguments, each) for each in armatures]
    targets = [target_of(each.file.filepath, each.choices) for each in bundles]
    if len(set(targets)) < len(targets):
        named = ", ".join(armature.name for armature in armatures)
        raise InvalidSettingError(
            f"{named} cannot all be written to {targets[0]}. Name one with --armature, or a"
            " folder to write to."
        )


def perform_export(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    arguments: argparse.Namespace,
    progress: Progress,
) -> VerbResult:
    """Write the current motion of the armature."""
    settings = _bundle(arguments, armature)
    exported = solve_in_subprocess(read_export(scene, armature, settings), arguments, progress)
    sentence = write_exported(scene, armature, settings, exported)
    figures = {
        "output": str(target_of(settings.file.filepath, settings.choices)),
        "n_frames": exported.written.n_frames,
        "n_bones": exported.written.n_bones,
        "notes": list(exported.written.notes),
    }
    return sentence, figures


def _bundle(arguments: argparse.Namespace, armature: bpy.types.Object) -> ExportBundle:
    choices = settings_from_arguments(arguments, ExportChoices)
    target = real_path(arguments.target)
    if target.is_dir():
        target /= f"{bpy.path.clean_name(armature.name)}{choices.file_format.ending}"
    return ExportBundle(choices, ExportFile(filepath=str(target)))
