"""Retarget: read the scene and write the result."""

from collections.abc import Iterable, Mapping
from contextlib import ExitStack
from functools import partial
from typing import NamedTuple

import bpy
import numpy as np

from ...solvers.errors import InvalidMotionError
from ...solvers.motion import HumanoidMap, describe_low_confidence
from ...solvers.retargeting import RootMotion
from ..actions.action_write import write_action
from ..actions.armature_read import read_take
from ..actions.armature_write import check_writable
from ..actions.bone_channels import animated_paths, bone_path
from ..actions.take import ArmatureTake
from ..blender import compat
from ..blender.block_references import BlockReference, SourceReference, kept_when_complete
from ..blender.compat import Source
from ..blender.name_lists import split_names
from ..blender.time_slices import Sliced, Steps
from ..jobs.job import MAX_SHORT_SOLVE_FRAMES, ShortSolve
from ..rigs.evaluated_body import body_bones, with_body_shown
from ..rigs.rigify import is_rigify
from ..rigs.role_confidence import explain_rig_roles
from ..rigs.target_read import read_target, vertical_part
from ..runtime.selection import played_source
from ..runtime.subject import Subject, check_unchanged
from ..scene import history
from .bone_map import LISTED_ARMATURES, BoneMaps, is_finger, maps_for
from .button_settings import RetargetBundle, RetargetChoices, Takes
from .solve_retargeting import (
    ReportedRetargeting,
    RetargetProblem,
    StagedMotion,
    retarget_and_report,
)


class RetargetScene(NamedTuple):
    """Source, target and bone maps that Retarget read from the scene."""

    target: bpy.types.Object
    sources: tuple[Source, ...]
    takes: tuple[ArmatureTake, ...]
    switches: Mapping[tuple[str, str], float]
    maps: BoneMaps
    problem: RetargetProblem

    def found_again(
        self, scene: bpy.types.Scene, source: bpy.types.Object, choices: RetargetChoices
    ) -> "RetargetScene":
        """Look up target and actions: pointers are stale after a time slice."""
        target = target_called(scene, choices.target, source)
        return self._replace(target=target, sources=chosen_sources(source, choices))


@Sliced
def read_retarget(
    scene: bpy.types.Scene, source: bpy.types.Object, settings: RetargetBundle
) -> "Steps[partial[ReportedRetargeting]]":
    """Read source and target; return the picklable solve."""
    found = yield from _read(Subject.of(scene, source), settings)
    problem = found.problem
    n_frames = sum(clip.motion.n_frames for clip in problem.clips)
    return (ShortSolve if n_frames <= MAX_SHORT_SOLVE_FRAMES else partial)(
        retarget_and_report, problem
    )


@Sliced
def write_retargeted(
    scene: bpy.types.Scene,
    source: bpy.types.Object,
    settings: RetargetBundle,
    results: ReportedRetargeting,
    solved_digest: str | None = None,
) -> Steps[str]:
    """Write an action for each clip, let the target play the last; return a sentence.

    A linked target plays nothing: its actions are for its override.
    """
    here = Subject.of(scene, source)
    found = yield from _read(here, settings)
    yield from check_unchanged.steps(here.find()[1], solved_digest, found.problem)
    scene, source = here.find()
    found = found.found_again(scene, source, settings.choices)
    low = _low_confidence(source, found)
    entry = _entry(source, found, settings)
    entry |= {"low_confidence": low, "remarks": list(results.remarks)}
    lasting = BlockReference.of(found.target)
    sources = [SourceReference.of(each) for each in found.sources]
    with ExitStack() as incomplete:
        for made_from, take, keys in zip(sources, found.takes, results.clips, strict=True):
            name = f"{made_from.action.name}.{lasting.name}"
            action, slot = yield from write_action.steps(
                lasting.find(), name, take.frames, keys, found.switches
            )
            incomplete.enter_context(kept_when_complete(action))
            history.record(action, made_from.find(), entry, of_another_rig=True)
    target = lasting.find()
    linked = target.library is not None
    if not linked:
        compat.assign(target, action, slot)
    n_bones, n_frames = len(results.clips[-1]), sum(len(take.frames) for take in found.takes)
    made = action.name if len(results.clips) == 1 else f"{len(results.clips)} actions"
    score = min(found.maps.source.score, found.maps.target.score)
    return (
        f"{made}: retargeted {n_frames} frames to {n_bones} bones of {target.name}"
        f" (bones matched {score:.0%})."
        + (" It is linked: assign the action to its library override." if linked else "")
        + "".join(f" {each}" for each in low.values() if each)
        + "".join(f" {each}." for each in results.remarks)
    )


def remarks_on_target(source: bpy.types.Object, target: bpy.types.Object) -> tuple[str, ...]:
    """Return the remarks stored with the target's retargeted action."""
    played = target.animation_data and target.animation_data.action
    entries = history.history(played) if played else []
    if not entries or entries[-1].get("source_armature") != source.name:
        return ()
    return tuple(map(str, entries[-1].get("remarks", ())))


def _low_confidence(source: bpy.types.Object, found: RetargetScene) -> dict[str, str]:
    """Return a sentence about bones with low confidence, or an empty text, for each side."""
    armatures = (source, found.target)
    return {
        side: describe_low_confidence(humanoid, explain_rig_roles(armature, humanoid))
        for side, humanoid, armature in zip(
            LISTED_ARMATURES, found.maps, armatures, strict=True
        )
    }


def target_called(
    scene: bpy.types.Scene, name: str, source: bpy.types.Object
) -> bpy.types.Object:
    """Return the armature of that name; raise InvalidMotionError where it cannot be used."""
    if not name:
        raise InvalidMotionError("Choose the target armature.")
    named = [each for each in scene.objects if each.name == name and each.type == "ARMATURE"]
    # A linked armature and its override may have one name; only the override can be animated.
    target = min(named, key=lambda each: each.library is not None, default=None)
    if target is None:
        raise InvalidMotionError(f"The scene has no armature {name}.")
    if target == source:
        raise InvalidMotionError(f"{name} is the source itself. Choose another target.")
    if target.library is None:
        check_writable(target)
    return target


def chosen_sources(source: bpy.types.Object, choices: RetargetChoices) -> tuple[Source, ...]:
    """Return the actions to retarget, and the slot of each that fits the armature."""
    if choices.takes is Takes.PLAYED:
        return (played_source(source),)
    if choices.takes is Takes.ALL:
        if not (fitting := fitting_actions(source)):
            raise InvalidMotionError(f"No action has keys for the bones of {source.name}.")
        return fitting
    names = split_names(choices.actions)
    if not names:
        raise InvalidMotionError("No action is listed. Add one to the list.")
    return tuple(source_called(name, source) for name in names)


def source_called(name: str, armature: bpy.types.Object) -> Source:
    """Return the action of that name, and its slot that keys any of the armature's bones.

    Raises InvalidMotionError where there is none.
    """
    action = bpy.data.actions.get(name)
    slot = None if action is None else _fitting_slot(action, _paths_of(armature))
    if slot is None:
        raise InvalidMotionError(
            f"There is no action {name} with keys for the bones of {armature.name}."
        )
    return action, slot


def fitting_actions(
    armature: bpy.types.Object, actions: Iterable[bpy.types.Action] | None = None
) -> tuple[Source, ...]:
    """Return all actions, or all of these, that key any of the armature's bones.

    Linked ones too. What was given to another armature, whose bones may have the same names,
    is left out.
    """
    paths = _paths_of(armature)
    found = [
        (each, _fitting_slot(each, paths))
        for each in (bpy.data.actions if actions is None else actions)
        if history.given_to(each) in {"", armature.name}
    ]
    return tuple((action, slot) for action, slot in found if slot is not None)


def _paths_of(armature: bpy.types.Object) -> frozenset[str]:
    return frozenset(bone_path(bone.name, "") for bone in armature.data.bones)


def _fitting_slot(
    action: bpy.types.Action, paths: frozenset[str]
) -> bpy.types.ActionSlot | None:
    """Return the first slot that keys any of the bones with these paths."""
    for slot in action.slots:
        if slot.target_id_type in compat.TARGETS and any(
            path[: path.rfind(".") + 1] in paths for path in animated_paths(action, slot)
        ):
            return slot
    return None


def _read(here: Subject, settings: RetargetBundle) -> Steps[RetargetScene]:
    choices = settings.choices
    scene, source = here.find()
    target_called(scene, choices.target, source)  # refuse an unusable target before reading
    lasting = [SourceReference.of(each) for each in chosen_sources(source, choices)]
    takes = []
    for each in lasting:
        take = yield from _read_clip(here, each, choices)
        takes.append(take)
    scene, source = here.find()
    target = target_called(scene, choices.target, source)
    sources = tuple(each.find() for each in lasting)
    maps, known = _roles(scene, source, target, choices)
    on_root = settings.retargeting.root_motion is RootMotion.ROOT_BONE
    roles = _roles_without_missing_fingers(maps)
    rig, switches = read_target(scene, target, roles, choices.limbs, on_root)
    problem = RetargetProblem(tuple(map(_clip, takes)), known, rig, settings.retargeting)
    return RetargetScene(target, sources, tuple(takes), switches, maps, problem)


def _read_clip(
    here: Subject, action: SourceReference, choices: RetargetChoices
) -> Steps[ArmatureTake]:
    """Read an action; of a control rig, the motion of its body."""
    scene, source = here.find()
    take = yield from read_take.steps(source, scene, source=action.find())
    scene, source = here.find()
    if not is_rigify(source.data.bones):
        return take
    target = target_called(scene, choices.target, source)
    _, known = _roles(scene, source, target, choices)
    return (yield from with_body_shown.steps(scene, source, take, known, action.find()))


def _roles(
    scene: bpy.types.Scene,
    source: bpy.types.Object,
    target: bpy.types.Object,
    choices: RetargetChoices,
) -> tuple[BoneMaps, HumanoidMap]:
    """Return the bones of both armatures by role, and those that show the source's body."""
    files = (choices.source_map_file, choices.target_map_file)
    maps = maps_for(scene, source, target, files)
    known = _existing_bones(maps.source, source)
    shows = is_rigify(source.data.bones)
    return maps, body_bones(known, source.data.bones) if shows else known


def _clip(take: ArmatureTake) -> StagedMotion:
    origin = take.rest.origins[0] * (1.0, 1.0, 0.0)
    return StagedMotion(take.parts[0].motion, origin, vertical_part(take.rest.rotations[0]))


def _roles_without_missing_fingers(maps: BoneMaps) -> HumanoidMap:
    """Return the target's roles, without fingers that the source lacks."""
    joints = maps.target.joints.items()
    kept = {role: bone for role, bone in joints if maps.source.has(role) or not is_finger(role)}
    return HumanoidMap(kept, maps.target.score)


def _existing_bones(roles: HumanoidMap, source: bpy.types.Object) -> HumanoidMap:
    """Return the roles of bones that the armature has."""
    bones = source.data.bones
    return HumanoidMap(
        {role: bone for role, bone in roles.joints.items() if bone in bones}, roles.score
    )


def _entry(
    source: bpy.types.Object, found: RetargetScene, settings: RetargetBundle
) -> dict[str, object]:
    """Return the entry for the action's history."""
    return {
        "operation": "retarget",
        "source_armature": source.name,
        "target_armature": found.target.name,
        "settings": history.json_ready(*settings),
        "bones": {
            "source": dict(found.maps.source.joints),
            "target": dict(found.maps.target.joints),
        },
        "score": float(np.round(min(each.score for each in found.maps), 3)),
    }
