"""Strengths of Clean at each frame: from their keys in the scene, or constant."""

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.denoising import PART_STRENGTHS
from ..actions.bone_channels import Curves, animated_curves
from .button_settings import CleanBundle

STRENGTHS = ("strength", *PART_STRENGTHS.values())
PATH = "mocap_assist.clean."
"""Data path of the sidebar's settings of Clean, from the scene."""


def read_strengths(
    scene: bpy.types.Scene, settings: CleanBundle, frames: Array
) -> dict[str, Array]:
    """Return each strength, 0 to 1, at each frame, shape (n_frames,), by its setting's name."""
    curves = curves_of_settings(scene) if settings.choices.keyed_strength else {}
    found = {}
    for name in STRENGTHS:
        values = np.full(len(frames), getattr(settings.denoising, name))
        if channel := curves.get((PATH + name, 0)):
            keyed = channel.values(frames)
            values = np.where(np.isnan(keyed), values, keyed.clip(0.0, 1.0))
        found[name] = values
    return found


def curves_of_settings(scene: bpy.types.Scene) -> Curves:
    """Return the F-Curves of the scene's own action; empty where it plays none."""
    animation = scene.animation_data
    if animation is None or animation.action is None or animation.action_slot is None:
        return {}
    return animated_curves(animation.action, animation.action_slot)
