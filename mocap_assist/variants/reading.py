"""Read example actions for the button Vary."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import bpy
import numpy as np

from ...solvers.errors import InvalidMotionError
from ...solvers.retargeting import RootMotion
from ..actions.armature_read import read_take
from ..actions.armature_write import check_writable
from ..actions.take import ArmatureTake
from ..blender.block_references import SourceReference
from ..blender.compat import Source
from ..blender.name_lists import split_names
from ..blender.time_slices import Sliced, Steps
from ..retarget.scene_retargeting import fitting_actions, source_called
from ..rigs.evaluated_body import body_bones, with_body_shown
from ..rigs.movers import movers_of
from ..rigs.rigify import is_rigify
from ..rigs.target_read import find_roles, read_target, vertical_part
from ..runtime.redo import fingerprint
from ..runtime.selection import played_source, selected_armature
from ..runtime.subject import Subject
from ..scene.scene_rate import scene_rate
from .button_settings import VaryBundle, VaryChoices
from .solve_varying import Controls, Varied, VaryProblem, vary
from .tags import examples_of, is_variant

Switches = Mapping[tuple[str, str], float]
_shown: dict[str, ArmatureTake] = {}
"""Bodies of control rigs that were read since the button was pressed: each frame takes
milliseconds, and what was solved is read again before it is written."""


class VaryScene(NamedTuple):
    """Examples and armature that Vary read from the scene."""

    sources: tuple[Source, ...]
    takes: tuple[ArmatureTake, ...]
    problem: VaryProblem
    switches: Switches
    """Custom properties to be keyed of a control rig, by bone and name."""
    movers: frozenset[str]
    """Bones of a control rig that move its body: what they did in the examples is no more."""


def why_not_vary(context: bpy.types.Context) -> str:
    """Return why the selection cannot be varied, or an empty text."""
    armature = selected_armature(context)
    if armature is None:
        return "Select the armature whose actions to vary."
    try:
        check_writable(armature)
        chosen_sources(armature, context.scene.mocap_assist.vary.settings().choices)
    except InvalidMotionError as error:
        return str(error)
    return ""


def chosen_sources(armature: bpy.types.Object, choices: VaryChoices) -> tuple[Source, ...]:
    """Return the chosen actions and their slots, by default what the armature plays.

    Where that is a variant, what it was made of is meant.
    """
    names = split_names(choices.actions)
    if not names:
        played = played_source(armature)
        known = [name for name in examples_of(played[0]) if name in bpy.data.actions]
        if not known:
            return (played,)
        names = known
    return tuple(source_called(name, armature) for name in names)


def candidate_actions(armature: bpy.types.Object) -> list[bpy.types.Action]:
    """Return the actions that may show a behavior: those for the armature, but no variants."""
    others = (action for action in bpy.data.actions if not is_variant(action))
    return [action for action, _ in fitting_actions(armature, others)]


@Sliced
def read_varying(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: VaryBundle
) -> "Steps[partial[Varied]]":
    """Read the actions; return the picklable solve."""
    check_writable(armature)
    _shown.clear()
    found = yield from read_chosen_actions.steps(scene, armature, settings)
    return partial(vary, found.problem)


@Sliced
def read_chosen_actions(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: VaryBundle
) -> Steps[VaryScene]:
    """Read the chosen actions; of control rigs, the motion of their bodies."""
    here = Subject.of(scene, armature)
    lasting = [SourceReference.of(each) for each in chosen_sources(armature, settings.choices)]
    takes = []
    for each in lasting:
        take = yield from _read_once(here, each)
        motion = take.parts[0].motion
        observed = (
            np.isfinite(motion.rotations).all() and np.isfinite(motion.root_positions).all()
        )
        if not observed:
            action, _ = each.find()
            raise InvalidMotionError(f"{action.name} has gaps. Press Clean first.")
        takes.append(take)
    scene, armature = here.find()
    sources = tuple(each.find() for each in lasting)
    controls, switches = (
        read_controls(scene, armature, takes[0])
        if is_rigify(armature.data.bones)
        else (None, {})
    )
    problem = VaryProblem(
        tuple(take.parts[0].motion for take in takes),
        settings.choices.n_variants,
        settings.varying,
        settings.planting if settings.choices.plant_feet else None,
        scene_rate(scene),
        controls,
    )
    rig, body = takes[0].rig, takes[0].parts[0]
    shown = [rig.bones[bone] for bone in body.bones] if controls is not None else []
    return VaryScene(sources, tuple(takes), problem, switches, movers_of(armature, shown))


def _read_once(here: Subject, source: SourceReference) -> Steps[ArmatureTake]:
    """Read an action; the body of a control rig only once for each press of the button."""
    scene, armature = here.find()
    take = yield from read_take.steps(armature, scene, source=source.find())
    scene, armature = here.find()
    if not is_rigify(armature.data.bones):
        return take
    known = fingerprint((armature.session_uid, take))
    if known not in _shown:
        _shown[known] = yield from _body_shown(scene, armature, take, source.find())
    return _shown[known]


@Sliced
def read_body(
    scene: bpy.types.Scene, armature: bpy.types.Object, source: Source
) -> Steps[ArmatureTake]:
    """Read an action; where constraints move the body, as Blender shows it, named by roles."""
    here, lasting = Subject.of(scene, armature), SourceReference.of(source)
    take = yield from read_take.steps(armature, scene, source=source)
    scene, armature = here.find()
    if not is_rigify(armature.data.bones):
        return take
    return (yield from _body_shown(scene, armature, take, lasting.find()))


def _body_shown(
    scene: bpy.types.Scene, armature: bpy.types.Object, take: ArmatureTake, source: Source
) -> Steps[ArmatureTake]:
    """Return a take of controls as one of the body that they move, named by roles."""
    bones = body_bones(find_roles(armature), armature.data.bones)
    shown = yield from with_body_shown.steps(scene, armature, take, bones, source)
    body, roles = shown.parts[0], {bone: role for role, bone in bones.joints.items()}
    skeleton = body.motion.skeleton
    names = tuple(roles[name] for name in skeleton.names)
    named = replace(body.motion, skeleton=replace(skeleton, names=names))
    return replace(shown, parts=(replace(body, motion=named), *shown.parts[1:]))


def read_controls(
    scene: bpy.types.Scene, armature: bpy.types.Object, take: ArmatureTake
) -> tuple[Controls, Switches]:
    """Read how a control rig is keyed, with the settings of the panel Retarget."""
    chosen = scene.mocap_assist.retarget.settings()
    on_root = chosen.retargeting.root_motion is RootMotion.ROOT_BONE
    rig, switches = read_target(
        scene, armature, find_roles(armature), chosen.choices.limbs, on_root
    )
    origin = take.rest.origins[0] * (1.0, 1.0, 0.0)
    rotation = vertical_part(take.rest.rotations[0])
    return Controls(rig, chosen.retargeting, origin, rotation), switches
