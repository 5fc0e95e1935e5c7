"""The verb `reconstruct`: what the button Reconstruct does."""

import argparse
from dataclasses import replace
from typing import Any, get_type_hints

import bpy

from ...solvers.command_line.options import arguments_from, settings_from_arguments
from ...solvers.progress import Progress
from ..blender.name_lists import join_names
from ..reconstruct.button_settings import Postures, ReconstructBundle
from ..reconstruct.reconstructing import read_reconstructing, write_reconstructed
from ..runtime.selection import played_source
from ..scene import history
from .solving import solve_in_subprocess


def add_reconstruct_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `reconstruct`; those of the button."""
    parser.add_argument(
        "--train", nargs="+", default=[], metavar="FILE",
        help="clean recordings, or folders of them, to learn postures from; short for"
        " --postures examples --examples",
    )  # fmt: skip
    parser.add_argument(
        "--library", metavar="FILE",
        help="clip library, of which postures are taken from what is like the take; short for"
        " --postures library",
    )  # fmt: skip
    arguments_from(parser, *get_type_hints(ReconstructBundle).values())


def perform_reconstruct(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    arguments: argparse.Namespace,
    progress: Progress,
) -> tuple[str, dict[str, Any]]:
    """Rebuild what the armature plays."""
    classes = get_type_hints(ReconstructBundle)
    settings = ReconstructBundle(**{
        name: settings_from_arguments(arguments, each) for name, each in classes.items()
    })
    if arguments.train:
        choices = replace(
            settings.choices,
            postures=Postures.EXAMPLES,
            examples=join_names(arguments.train),
        )
        settings = settings._replace(choices=choices)
    elif arguments.library:
        scene.mocap_assist.library.library_file = arguments.library
        choices = replace(settings.choices, postures=Postures.LIBRARY)
        settings = settings._replace(choices=choices)
    rebuilt = solve_in_subprocess(
        read_reconstructing(scene, armature, settings), arguments, progress
    )
    sentence = write_reconstructed(scene, armature, settings, rebuilt)
    action, _ = played_source(armature)
    return sentence, {"action": action.name} | history.history(action)[-1]
