"""The verb `reconstruct`: what the button Reconstruct does."""

import argparse
from dataclasses import replace
from typing import Any

import bpy

from ...solvers.command_line.arguments import add_preset_option
from ...solvers.progress import Progress
from ..blender.name_lists import join_names
from ..reconstruct.button_settings import Postures, ReconstructBundle
from ..reconstruct.scene_reconstructing import read_reconstructing, write_reconstructed
from ..runtime.selection import played_source
from ..scene import history
from .bundles import add_bundle_options, bundle_from_arguments
from .solving import solve_in_subprocess


def add_reconstruct_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `reconstruct`; those of the button."""
    parser.add_argument(
        "--train", nargs="+", default=[], metavar="FILE",
        help="clean recordings, or folders of them, to take poses from (same as --postures"
        " examples --examples)",
    )  # fmt: skip
    parser.add_argument(
        "--library", metavar="FILE",
        help="clip library; take poses from its clips most similar to the take (same as"
        " --postures library)",
    )  # fmt: skip
    add_preset_option(parser, "reconstruct")
    add_bundle_options(parser, ReconstructBundle)


def perform_reconstruct(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    arguments: argparse.Namespace,
    progress: Progress,
) -> tuple[str, dict[str, Any]]:
    """Reconstruct the action that the armature plays."""
    settings = bundle_from_arguments(arguments, ReconstructBundle)
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
    return sentence, {"action": action.name, **history.history(action)[-1]}
