"""Plant Feet: read the scene and write the result."""

from functools import partial
from typing import NamedTuple

import bpy

from ...solvers.denoising import PlantSettings
from ..actions.armature_read import read_take
from ..actions.armature_write import Output, assign_result, check_writable, write_take
from ..actions.contact_keys import animators_contacts, write_contacts
from ..blender.time_slices import Sliced, Steps
from ..jobs.job import MAX_SHORT_SOLVE_FRAMES, ShortSolve
from ..runtime.played import Played
from ..runtime.selection import played_source
from ..runtime.subject import Subject, check_unchanged
from ..scene import history
from .solve_planting import Replanted, plant


class FeetBundle(NamedTuple):
    """Settings of the button."""

    planting: PlantSettings


@Sliced
def read_planting(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: FeetBundle
) -> "Steps[partial[Replanted]]":
    """Read the action that an armature plays; return the picklable solve."""
    check_writable(armature)
    here = Subject.of(scene, armature)
    take = yield from read_take.steps(armature, scene, source=played_source(armature))
    _, armature = here.find()
    contacts = animators_contacts(played_source(armature), take.frames)
    kind = ShortSolve if len(take.frames) <= MAX_SHORT_SOLVE_FRAMES else partial
    return kind(plant, take.parts[0].motion, contacts, settings.planting)


@Sliced
def write_planted(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    settings: FeetBundle,
    result: Replanted,
    solved_digest: str | None = None,
) -> Steps[str]:
    """Write the result as a new action and assign it; return a message."""
    read = Played.of(scene, armature)
    take = yield from read_take.steps(armature, scene, source=played_source(armature))
    body, *other_trees = take.recordings
    yield from check_unchanged.steps(read.find()[1], solved_digest, body)
    planted = result.planted
    take = take.with_recordings((planted.motion, *other_trees))
    _, armature, played = read.find()
    action, slot = yield from write_take.steps(armature, played, take, result.moved, {})
    _, armature, played = read.find()
    edited, contacts = animators_contacts(played, take.frames), planted.all_contacts
    write_contacts(armature, action, slot, take.frames, contacts, detected=True, edited=edited)
    entry = {
        "operation": "plant_feet",
        "settings": history.json_ready(*settings),
        "slide_before_cm": 100 * planted.slide_before,
        "slide_after_cm": 100 * planted.slide_after,
    }
    history.record(action, played, entry)
    assign_result(armature, action, slot, Output.ACTION)
    message = (
        f"{action.name}: slide on the floor {100 * planted.slide_before:.1f} →"
        f" {100 * planted.slide_after:.1f} cm, moved {len(result.moved)} bones."
    )
    return " ".join([message, *(f"{remark}." for remark in planted.remarks)])
