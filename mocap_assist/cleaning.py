"""What the button Clean reads from the scene, and what it writes back."""

from dataclasses import replace
from functools import partial
from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ..solvers.denoising import Denoised
from ..solvers.errors import InvalidMotionError
from . import redo
from .clean_choices import Bones, CleanChoices, CleanSettings, Limits
from .clean_report import clean_report, entry_of
from .examples import read_examples
from .jobs.cleaning import Cleaned, Finish, Problem, Recordings, clean, names_of
from .scene import compat, history
from .scene.armature_read import action_of, read_take
from .scene.armature_write import check_writable, put_to_use, write_take
from .scene.compat import Source
from .scene.contacts import read_contacts, write_contacts
from .scene.curves import GENERATED, MEASURED
from .scene.limits import read_limits
from .scene.take import ArmatureTake

UNSURE = 0.5  # confidence below which a key counts as generated
EASE = 5  # frames over which a cleaned range joins the frames outside it


class Reading(NamedTuple):
    """What Clean found in the scene."""

    armature: bpy.types.Object
    recorded: Source
    played: Source
    """What the armature plays: the recorded action, or an earlier result made from it."""
    raw: ArmatureTake
    bones: frozenset[str]
    """Those to change."""


def selected_armature(context: bpy.types.Context) -> bpy.types.Object | None:
    """Return the active object if it is an armature."""
    active = context.view_layer.objects.active
    return active if active is not None and active.type == "ARMATURE" else None


def why_not_clean(context: bpy.types.Context) -> str:
    """Return why the button is grey, or nothing."""
    armature = selected_armature(context)
    if armature is None:
        return "Select an armature that plays a captured action."
    try:
        check_writable(armature)
        played_source(armature)
    except InvalidMotionError as error:
        return str(error)
    return ""


def played_source(armature: bpy.types.Object) -> Source:
    """Return what the armature plays: a result of ours, or its action."""
    return history.played_result(armature) or action_of(armature)


def read_cleaning(context: bpy.types.Context, settings: CleanSettings) -> "partial[Cleaned]":
    """Read the active armature; return what is to be solved, which may be pickled."""
    choices = settings.choices
    found = _read(context, choices)
    limits = None
    if choices.joint_limits is Limits.CONSTRAINTS:
        limits = read_limits(found.armature, found.raw, found.bones)
    problem = _problem(context, found, settings)
    finish = Finish(
        strength=settings.denoising.strength,
        ease=_ease(found.raw),
        chosen=found.bones,
        present=_present(context, found),
        limits=limits,
        planting=settings.planting if choices.plant_feet else None,
        contacts=read_contacts(*found.played, found.raw.frames),
    )
    return partial(clean, problem, finish, redo.recall(problem))


def write_cleaned(context: bpy.types.Context, settings: CleanSettings, cleaned: Cleaned) -> str:
    """Write the result as a new action and put it to use; return a sentence about it."""
    found = _read(context, settings.choices)
    redo.remember(_problem(context, found, settings), cleaned.solution)
    take = found.raw.with_recordings(cleaned.recordings)
    bones = cleaned.moved | found.bones
    types = key_types(found.raw, cleaned.solution.denoised)
    action, slot = write_take(found.armature, found.played, take, bones, types)
    if cleaned.planted is not None:
        contacts = cleaned.planted.contacts
        write_contacts(found.armature, action, slot, take.frames, contacts)
    history.record(action, found.played, entry_of("denoise", settings, cleaned))
    put_to_use(found.armature, action, slot, settings.choices.output)
    return clean_report(found.raw, cleaned, action.name)


def chosen_bones(armature: bpy.types.Object, choice: Bones) -> frozenset[str]:
    """Return the names of the bones to change, of which there must be one."""
    bones = armature.pose.bones
    if choice is Bones.ALL:
        return frozenset(bone.name for bone in bones)
    selected = frozenset(bone.name for bone in bones if compat.is_selected(bone))
    if not selected:
        raise InvalidMotionError(
            "No bones are selected. Select some in Pose Mode, or clean all bones."
        )
    return selected


def key_types(
    raw: ArmatureTake, denoised: tuple[Denoised, ...]
) -> dict[str, NDArray[np.uint8]]:
    """Paint the keys of each bone: what was filled or corrected is GENERATED, the rest not."""
    types: dict[str, NDArray[np.uint8]] = {}
    for recording, result in zip(raw.recordings, denoised, strict=True):
        unsure = result.outliers | (result.confidence < UNSURE)
        for name, flags in zip(names_of(recording), unsure.T, strict=True):
            painted = np.where(flags, GENERATED, MEASURED).astype(np.uint8)
            types[name] = np.maximum(painted, types.get(name, MEASURED))
    return types


def _read(context: bpy.types.Context, choices: CleanChoices) -> Reading:
    armature = selected_armature(context)
    check_writable(armature)
    bones = chosen_bones(armature, choices.bones)
    played = played_source(armature)
    recorded = history.raw_of(played[0]) or played
    raw = read_take(armature, context.scene, choices.frame_range, recorded)
    return Reading(armature, recorded, played, raw, bones)


def _problem(context: bpy.types.Context, found: Reading, settings: CleanSettings) -> Problem:
    examples = read_examples(context, found.armature, settings.choices)
    denoising = replace(settings.denoising, strength=1.0)
    return Problem(recordings=found.raw.recordings, settings=denoising, examples=examples)


def _present(context: bpy.types.Context, found: Reading) -> Recordings | None:
    """What an earlier result shows of the bones that stay, if it differs from the recording."""
    everything = len(found.bones) == len(found.raw.rig.bones)
    if everything or found.played == found.recorded:
        return None
    grid = found.raw.grid
    present = read_take(found.armature, context.scene, source=found.played, grid=grid)
    same = [names_of(one) for one in present.recordings] == [
        names_of(one) for one in found.raw.recordings
    ]
    return present.recordings if same else None


def _ease(raw: ArmatureTake) -> NDArray[np.float64]:
    """Rise from 0 and fall to 0 where the action goes on before or after the cleaned frames."""
    n_frames = len(raw.frames)
    ramp = np.minimum((np.arange(n_frames) + 1.0) / (EASE + 1.0), 1.0)
    before, after = raw.grid.joins
    return np.minimum(ramp if before else 1.0, ramp[::-1] if after else np.ones(n_frames))
