"""Reconstruct: read the scene and write the result."""

from functools import partial
from typing import Any, NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.errors import InvalidMotionError
from ...solvers.motion import Motion, Sensor
from ..actions.armature_read import read_take
from ..actions.armature_write import assign_result, check_writable, count_modified, write_take
from ..actions.bone_lengths import has_constant_locations, key_lengths, length_locations
from ..actions.contact_keys import animators_contacts, write_contacts
from ..actions.curves import GENERATED, MEASURED
from ..actions.reliability_curves import Term, write_reliability
from ..actions.sensor_notes import read_states
from ..actions.take import ArmatureTake
from ..blender.compat import Source
from ..blender.path_properties import absolute
from ..blender.time_slices import Sliced, Steps
from ..clean.example_source import ExampleSource
from ..clean.examples import read_examples
from ..clean.report import overall_figures
from ..clean.scene_cleaning import ease_of
from ..jobs.job import ShortSolve
from ..library.library_prior import library_prior
from ..runtime import redo
from ..runtime.played import Played
from ..runtime.selection import played_source, selected_armature, why_not_clean
from ..runtime.subject import Subject, check_unchanged
from ..scene import history
from ..scene.origin import origin_of
from .button_settings import Postures, ReconstructBundle
from .solve_reconstructing import RebuildFinish, RebuildProblem, Rebuilt, rebuild

SUFFIX = ".reconstructed"


class _ReconstructScene(NamedTuple):
    """Action of an armature, and the recording of its joints."""

    played: Source
    recorded: Source
    take: ArmatureTake

    @classmethod
    def of(
        cls, scene: bpy.types.Scene, armature: bpy.types.Object, settings: ReconstructBundle
    ) -> "Steps[_ReconstructScene]":
        check_writable(armature)
        here = Subject.of(scene, armature)
        played = played_source(armature)
        recorded = history.raw_of(played[0]) or played
        take = yield from read_take.steps(
            armature, scene, settings.choices.frame_range, recorded
        )
        played = played_source(here.find()[1])
        return cls(played, history.raw_of(played[0]) or played, take)

    @property
    def body(self) -> Motion:
        return self.take.parts[0].motion


def why_not_reconstruct(context: bpy.types.Context) -> str:
    """Return why the selection cannot be reconstructed, or an empty text."""
    if selected_armature(context) is None:
        return "Select an animated armature. Import depth camera joints as an armature."
    return why_not_clean(context)


@Sliced
def read_reconstructing(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: ReconstructBundle
) -> "Steps[partial[Rebuilt]]":
    """Read what was recorded; return the picklable solve."""
    reading, problem = yield from _read(Subject.of(scene, armature), settings)
    finish = RebuildFinish(
        ease=ease_of(reading.take.grid),
        planting=settings.planting if settings.choices.plant_feet else None,
        contacts=animators_contacts(reading.played, reading.take.frames),
    )
    solution = yield from redo.stored_solution.steps(problem)
    return (partial if solution is None else ShortSolve)(rebuild, problem, finish, solution)


@Sliced
def write_reconstructed(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    settings: ReconstructBundle,
    rebuilt: Rebuilt,
    solved_digest: str | None = None,
) -> Steps[str]:
    """Write the result as a new action and assign it; return a message.

    Raises InvalidMotionError if the armature plays another motion than the one that was solved.
    """
    read = Played.of(scene, armature)
    reading, problem = yield from _read(read.here, settings)
    yield from check_unchanged.steps(read.find()[1], solved_digest, problem)
    yield from redo.store_solution.steps(problem, rebuilt.solution)
    _, armature, played = read.find()
    recorded = history.raw_of(played[0]) or played
    names = problem.body.skeleton.names
    bones = frozenset(names) & frozenset(reading.take.rig.bones)
    other_trees = reading.take.recordings[1:]
    take = reading.take.with_recordings((rebuilt.motion, *other_trees))
    n_modified = count_modified(recorded, bones)
    action, slot = yield from write_take.steps(
        armature, recorded, take, bones, _key_types(names, rebuilt), suffix=SUFFIX
    )
    _, armature, played = read.find()
    if problem.resize:
        lengths = length_locations(reading.take, rebuilt.motion.skeleton)
        key_lengths(action, slot, lengths, reading.take.frames[0])
    for term in Term:
        values = getattr(rebuilt.solution.reliability_terms, term.name.lower())
        reliability = dict(zip(names, values.T, strict=True))
        write_reliability(armature, action, slot, take.frames, reliability, term)
    if rebuilt.planted is not None:
        edited, contacts = animators_contacts(played, take.frames), rebuilt.planted.all_contacts
        write_contacts(
            armature, action, slot, take.frames, contacts, detected=True, edited=edited
        )
    recorded = history.raw_of(played[0]) or played
    history.record(action, recorded, _entry(settings, rebuilt))
    assign_result(armature, action, slot, settings.choices.result_as)
    return _message_of(action.name, rebuilt, n_modified)


def _read(
    here: Subject, settings: ReconstructBundle
) -> Steps[tuple[_ReconstructScene, RebuildProblem]]:
    """Read the pose library's sources, and then the recording."""
    examples, choices = None, settings.choices
    if choices.postures is Postures.EXAMPLES:
        examples = yield from read_examples.steps(*here.find(), choices.examples)
    reading = yield from _ReconstructScene.of(*here.find(), settings)
    return reading, _problem(*here.find(), reading, settings, examples)


def _problem(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    reading: _ReconstructScene,
    settings: ReconstructBundle,
    examples: ExampleSource | None,
) -> RebuildProblem:
    body = reading.body
    choices, postures, library = settings.choices, None, None
    if choices.postures is Postures.LIBRARY:
        library = library_prior(scene, armature)
    elif choices.postures is Postures.LEARNED:
        if not choices.postures_file:
            raise InvalidMotionError("Choose a pose file, or another source of poses.")
        postures = _file_and_date(choices.postures_file)
    state = read_states(reading.recorded, body.skeleton.names, reading.take.frames)
    return RebuildProblem(
        body=body,
        tracking_state=state,
        source=_source_of(reading.recorded[0]),
        sensor=_sensor_of(reading.recorded[0]),
        resize=_is_resizable(reading.take),
        settings=settings.rebuilding,
        examples=examples,
        postures_file=postures,
        residuals_file=_file_and_date(choices.residuals_file)
        if choices.residuals_file
        else None,
        library=library,
    )


def _source_of(action: bpy.types.Action) -> tuple[str, int, str] | None:
    """Return the file of an action, its date, and its body there; None if it is gone."""
    origin = origin_of(action)
    path, body = (str(origin.get(name, "")) for name in ("file", "body"))
    return (*_file_and_date(path), body) if absolute(path).is_file() else None


def _is_resizable(take: ArmatureTake) -> bool:
    """Whether constant locations can change bones: an import with keys for them, as a whole."""
    return has_constant_locations(take) and bool((ease_of(take.grid) == 1.0).all())


def _sensor_of(action: bpy.types.Action) -> Sensor:
    """Return the sensor that an action was imported from."""
    noted = str(origin_of(action).get("sensor", ""))
    return Sensor(noted) if noted in {one.value for one in Sensor} else Sensor.OTHER


def _file_and_date(file: str) -> tuple[str, int]:
    """Return a file and its date; 0 if it is missing, which its reader reports."""
    path = absolute(file)
    return str(path), path.stat().st_mtime_ns if path.is_file() else 0


def _key_types(names: tuple[str, ...], rebuilt: Rebuilt) -> dict[str, NDArray[np.uint8]]:
    """Paint the keys of joints that were rebuilt."""
    painted = np.where(rebuilt.solution.rebuilt, GENERATED, MEASURED).astype(np.uint8)
    return dict(zip(names, painted.T, strict=True))


def _entry(settings: ReconstructBundle, rebuilt: Rebuilt) -> dict[str, Any]:
    """Return the entry for the action's history, JSON-ready."""
    return {
        "operation": "reconstruct",
        "settings": history.json_ready(*settings),
        "method": rebuilt.solution.method,
        "rebuilt_share": rebuilt.solution.rebuilt_fraction,
        "remarks": list(rebuilt.remarks),
        "before": overall_figures(rebuilt.before),
        "after": overall_figures(rebuilt.after),
    }


def _message_of(name: str, rebuilt: Rebuilt, n_modified: int) -> str:
    """Return the message for the status bar, with warnings."""
    percent = 100 * rebuilt.solution.rebuilt_fraction
    remarks = [f"{name}: rebuilt {percent:.1f} % of joint samples."]
    if planted := rebuilt.planted:
        before, after = 100 * planted.slide_before, 100 * planted.slide_after
        remarks.append(f"Slide on the floor {before:.1f} → {after:.1f} cm.")
    remarks += rebuilt.remarks
    if n_modified:
        remarks.append(f"Applied the modifiers of {n_modified} curves.")
    return " ".join(remarks)
