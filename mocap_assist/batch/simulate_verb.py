"""The verb `simulate`: what the button Simulate does."""

import argparse
from typing import Any

import bpy

from ...solvers.command_line.arguments import (
    add_preset_option,
    arguments_from,
    settings_from_arguments,
)
from ...solvers.physics import SimulateSettings
from ...solvers.progress import Progress
from ..physics.scene_simulating import SimulateBundle, read_simulating, write_simulated
from ..scene import history
from .solving import solve_in_subprocess


def add_simulate_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `simulate`; those of the button."""
    add_preset_option(parser, "simulate")
    arguments_from(parser, SimulateSettings)


def perform_simulate(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    arguments: argparse.Namespace,
    progress: Progress,
) -> tuple[str, dict[str, Any]]:
    """Simulate the motion of the armature with a physical body."""
    settings = SimulateBundle(settings_from_arguments(arguments, SimulateSettings))
    result = solve_in_subprocess(
        read_simulating(scene, armature, settings), arguments, progress
    )
    sentence = write_simulated(scene, armature, settings, result)
    action = armature.animation_data.action
    return sentence, {"action": action.name, **history.history(action)[-1]}
