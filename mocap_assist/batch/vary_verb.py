"""The verb `vary`: what the button Vary does."""

import argparse
from pathlib import Path
from typing import Any

import bpy

from ...solvers.command_line.arguments import add_preset_option
from ...solvers.progress import Progress, within
from ..variants.button_settings import VaryBundle
from ..variants.listing import chosen_variants
from ..variants.reading import read_varying
from ..variants.sheet import write_sheet
from ..variants.writing import write_variants
from .bundles import add_bundle_options, bundle_from_arguments
from .solving import solve_in_subprocess

HELP = "Generate variations of a few similar actions."


def add_vary_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `vary`; those of the button, and the contact sheet."""
    parser.add_argument(
        "--sheet", type=Path, metavar="FILE", help="draw all variants to a PNG file"
    )
    add_preset_option(parser, "vary")
    add_bundle_options(parser, VaryBundle)


def perform_vary(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    arguments: argparse.Namespace,
    progress: Progress,
) -> tuple[str, dict[str, Any]]:
    """Make variants of the armature's actions; it plays the first."""
    settings = bundle_from_arguments(arguments, VaryBundle)
    varied = solve_in_subprocess(
        read_varying(scene, armature, settings), arguments, within(progress, 0.0, 0.8)
    )
    progress(0.8, "Writing")
    message = write_variants(scene, armature, settings, varied)
    if arguments.sheet is not None:
        message += " " + write_sheet(scene, arguments.sheet)
    names = [action.name for action in chosen_variants(scene)]
    return message, {"actions": names, "remarks": list(varied.remarks)}
