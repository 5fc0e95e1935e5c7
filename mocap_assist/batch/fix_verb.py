"""The verb `fix`: what the button Fix My Take does."""

import argparse
from typing import Any

import bpy

from ...solvers.progress import Progress
from ..fix.button_settings import FixBundle
from ..fix.scene_fixing import fixed_subject, read_fixing, write_fixed
from ..panel_parts.fix_card import stored_card
from ..runtime.selection import played_source
from ..scene import history
from .bundles import add_bundle_options, bundle_from_arguments
from .solving import solve_in_subprocess


def add_fix_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `fix`; those of the button."""
    add_bundle_options(parser, FixBundle)


def perform_fix(
    scene: bpy.types.Scene,
    subject: bpy.types.Object,
    arguments: argparse.Namespace,
    progress: Progress,
) -> tuple[str, dict[str, Any]]:
    """Fix the action that an armature or markers play."""
    settings = bundle_from_arguments(arguments, FixBundle)
    fixed = solve_in_subprocess(read_fixing(scene, subject, settings), arguments, progress)
    sentence = write_fixed(scene, subject, settings, fixed)
    action, _ = played_source(fixed_subject(subject, fixed))
    report = stored_card(action)
    text = "\n".join([sentence, *report["steps"]])
    return text, {"action": action.name, **history.history(action)[-1], **report}
