"""What the button Vary reads from the scene."""

from functools import partial
from typing import NamedTuple

import bpy

from ...solvers.errors import InvalidMotionError
from ..examples import SEPARATOR
from ..jobs.varying import Varied, VaryProblem, vary
from ..retargeting import fitting_actions, source_called
from ..scene.armature_read import read_take
from ..scene.armature_write import check_writable
from ..scene.compat import Source
from ..scene.rigify import is_rigify
from ..scene.scene_rate import scene_rate
from ..scene.take import ArmatureTake
from ..selection import played_source, selected_armature
from .choices import VaryBundle, VaryChoices
from .tags import examples_of, is_variant


class Reading(NamedTuple):
    """What Vary found in the scene."""

    sources: tuple[Source, ...]
    takes: tuple[ArmatureTake, ...]
    problem: VaryProblem


def why_not_vary(context: bpy.types.Context) -> str:
    """Return why nothing can be varied, or nothing."""
    armature = selected_armature(context)
    if armature is None:
        return "Select the armature whose actions are to be varied."
    if is_rigify(armature.data.bones):
        return (
            f"{armature.name} is a control rig. Vary the captured skeleton, and retarget the"
            " variants."
        )
    try:
        check_writable(armature)
        chosen_sources(armature, context.scene.mocap_assist.vary.settings().choices)
    except InvalidMotionError as error:
        return str(error)
    return ""


def chosen_sources(armature: bpy.types.Object, choices: VaryChoices) -> tuple[Source, ...]:
    """Return the chosen actions and their slots; without any what the armature plays.

    Where that is a variant, what it was made of is meant.
    """
    names = [name.strip() for name in choices.actions.split(SEPARATOR) if name.strip()]
    if not names:
        played = played_source(armature)
        known = [name for name in examples_of(played[0]) if name in bpy.data.actions]
        if not known:
            return (played,)
        names = known
    return tuple(source_called(name, armature) for name in names)


def candidates(armature: bpy.types.Object) -> list[bpy.types.Action]:
    """Return the actions that may show a behaviour: those for the armature, but no variants."""
    return [action for action, _ in fitting_actions(armature) if not is_variant(action)]


def read_varying(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: VaryBundle
) -> "partial[Varied]":
    """Read the actions; return what is to be solved, which may be pickled."""
    check_writable(armature)
    return partial(vary, read(scene, armature, settings).problem)


def read(scene: bpy.types.Scene, armature: bpy.types.Object, settings: VaryBundle) -> Reading:
    """Read the chosen actions."""
    sources = chosen_sources(armature, settings.choices)
    takes = tuple(read_take(armature, scene, source=each) for each in sources)
    problem = VaryProblem(
        tuple(take.parts[0].motion for take in takes),
        settings.choices.n_variants,
        settings.varying,
        settings.planting if settings.choices.plant_feet else None,
        scene_rate(scene),
    )
    return Reading(sources, takes, problem)
