"""Strengths of Clean at each frame: from their keys in the scene, or constant."""

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.denoising import PART_STRENGTHS
from ..actions.bone_channels import Curves, animated_curves
from ..actions.curves import Channel
from .button_settings import CleanBundle

STRENGTHS = ("strength", *PART_STRENGTHS.values())
PATH = "mocap_assist.clean."
"""Data path of the sidebar's settings of Clean, from the scene."""


def read_strengths(
    scene: bpy.types.Scene, settings: CleanBundle, frames: Array
) -> dict[str, Array]:
    """Return each strength, 0 to 1, at each frame, shape (n_frames,), by its setting's name."""
    channels = _keyed_channels(scene, settings)
    found = {}
    for name in STRENGTHS:
        values = np.full(len(frames), getattr(settings.denoising, name))
        if channel := channels.get(name):
            keyed = channel.values(frames)
            values = np.where(np.isnan(keyed), values, keyed.clip(0.0, 1.0))
        found[name] = values
    return found


def keyed_strengths(
    scene: bpy.types.Scene, settings: CleanBundle, *, has_parts: bool
) -> tuple[str, ...]:
    """Return the names of the strengths that keys set, of parts where the take has parts."""
    channels = _keyed_channels(scene, settings)
    return tuple(name for name in channels if has_parts or name == "strength")


def _keyed_channels(scene: bpy.types.Scene, settings: CleanBundle) -> dict[str, Channel]:
    if not settings.choices.keyed_strength:
        return {}
    curves = curves_of_settings(scene)
    found = {name: curves.get((PATH + name, 0)) for name in STRENGTHS}
    return {name: channel for name, channel in found.items() if channel}


def curves_of_settings(scene: bpy.types.Scene) -> Curves:
    """Return the F-Curves of the scene's own action; empty where it plays none."""
    animation = scene.animation_data
    if animation is None or animation.action is None or animation.action_slot is None:
        return {}
    return animated_curves(animation.action, animation.action_slot)
