"""The verbs `retarget` and `unbake`: what the buttons of the same names do."""

import argparse
from typing import Any

import bpy

from ...solvers.command_line.arguments import (
    add_preset_option,
    arguments_from,
    settings_from_arguments,
)
from ...solvers.command_line.retarget_verbs import add_tolerance_option
from ...solvers.progress import Progress
from ...solvers.recordings.conventions import CENTIMETER
from ...solvers.retargeting import RetargetSettings, UnbakeSettings
from ..retarget.button_settings import (
    RetargetBundle,
    RetargetChoices,
    UnbakeBundle,
    UnbakeChoices,
)
from ..retarget.scene_retargeting import read_retarget, write_retargeted
from ..retarget.scene_unbaking import read_unbaking, write_unbaked
from ..scene import history
from .solving import solve_in_subprocess

VerbResult = tuple[str, dict[str, Any]]


def add_retarget_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `retarget`; those of the button."""
    add_preset_option(parser, "retarget")
    arguments_from(parser, RetargetChoices, RetargetSettings)


def retarget_target(arguments: argparse.Namespace) -> str:
    """Return the name of the target armature, which is not a source."""
    return str(getattr(arguments, "target", ""))  # only what was given is there


def perform_retarget(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    arguments: argparse.Namespace,
    progress: Progress,
) -> VerbResult:
    """Retarget the armature's motions to the target."""
    settings = RetargetBundle(
        settings_from_arguments(arguments, RetargetChoices),
        settings_from_arguments(arguments, RetargetSettings),
    )
    results = solve_in_subprocess(read_retarget(scene, armature, settings), arguments, progress)
    sentence = write_retargeted(scene, armature, settings, results)
    action = scene.objects[settings.choices.target].animation_data.action
    figures = {"n_actions": len(results.clips), "action": action.name}
    return sentence, {**figures, **history.history(action)[-1]}


def add_unbake_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `unbake`."""
    add_tolerance_option(parser, "hands, feet and head")
    arguments_from(parser, UnbakeSettings)


def perform_unbake(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    arguments: argparse.Namespace,
    progress: Progress,
) -> VerbResult:
    """Reduce the keys of the action that the armature plays."""
    settings = UnbakeBundle(
        UnbakeChoices(tolerance=CENTIMETER * arguments.tolerance),
        settings_from_arguments(arguments, UnbakeSettings),
    )
    result = solve_in_subprocess(read_unbaking(scene, armature, settings), arguments, progress)
    sentence = write_unbaked(scene, armature, settings, result)
    action = armature.animation_data.action
    return sentence, {"action": action.name, **history.history(action)[-1]}
