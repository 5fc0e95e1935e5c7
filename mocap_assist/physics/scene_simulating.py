"""Simulate: read the scene and write the result."""

from functools import partial
from typing import NamedTuple

import bpy

from ...solvers.physics import SimulateSettings, describe_first_failure
from ..actions.armature_read import read_take
from ..actions.armature_write import Output, assign_result, check_writable, write_take
from ..blender.time_slices import Sliced, Steps
from ..jobs.job import ShortSolve
from ..runtime import redo
from ..runtime.played import Played
from ..runtime.selection import played_source, timeline_frames
from ..runtime.subject import check_unchanged
from ..scene import history
from .solve_simulating import Resimulated, simulate_take, take_of

SUFFIX = ".physics"


class SimulateBundle(NamedTuple):
    """Settings of the button."""

    simulating: SimulateSettings


@Sliced
def read_simulating(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: SimulateBundle
) -> "Steps[partial[Resimulated]]":
    """Read the action that an armature plays; return the picklable solve."""
    check_writable(armature)
    read = yield from read_take.steps(armature, scene, source=played_source(armature))
    take = take_of(read.parts[0].motion, settings.simulating)
    cached = yield from redo.stored_solution.steps(take)
    kind = partial if cached is None else ShortSolve
    return kind(simulate_take, take, settings.simulating.strength, cached)


@Sliced
def write_simulated(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    settings: SimulateBundle,
    result: Resimulated,
    solved_digest: str | None = None,
) -> Steps[str]:
    """Write the result as a new action and assign it; return a message.

    Raises InvalidMotionError if the armature plays another motion than the one that was solved.
    """
    present = Played.of(scene, armature)
    read = yield from read_take.steps(armature, scene, source=played_source(armature))
    take = take_of(read.parts[0].motion, settings.simulating)
    yield from check_unchanged.steps(present.find()[1], solved_digest, take)
    yield from redo.store_solution.steps(take, result.simulated)
    _, armature, played = present.find()
    read = read.with_recordings((result.body, *read.recordings[1:]))
    action, slot = yield from write_take.steps(
        armature, played, read, result.moved, {}, suffix=SUFFIX
    )
    _, armature, played = present.find()
    history.record(action, played, _entry(settings, result))
    assign_result(armature, action, slot, Output.ACTION)
    frames = timeline_frames(armature, read.frames)
    failure = describe_first_failure(result.simulated.followed, frames)
    message = f"{result.simulated.message} {failure}".rstrip()
    return f"{action.name}: {len(result.moved)} bones moved. {message}"


def _entry(settings: SimulateBundle, result: Resimulated) -> dict[str, object]:
    simulated = result.simulated
    return {
        "operation": "simulate",
        "settings": history.json_ready(*settings),
        "frames_not_followed": int((~simulated.followed).sum()),
        "ground_m": simulated.ground,
        "at_full_strength": {
            "penetration_before_cm": 100 * simulated.penetration_before,
            "penetration_after_cm": 100 * simulated.penetration_after,
            "slide_before_cm": 100 * simulated.slide_before,
            "slide_after_cm": 100 * simulated.slide_after,
            "distance_cm": 100 * simulated.distance,
        },
    }
