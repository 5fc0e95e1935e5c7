"""Clean: read the scene and write the result."""

from functools import partial

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.denoising import Denoised
from ...solvers.errors import InvalidMotionError
from ...solvers.motion import Tracks
from ..actions.curves import GENERATED, MEASURED
from ..actions.frames import Grid
from ..actions.markers.take import MarkerTake
from ..actions.take import ArmatureTake
from ..blender.time_slices import Sliced, Steps, in_thread
from ..jobs.job import ShortSolve
from ..library.library_prior import library_prior
from ..runtime import redo
from ..runtime.selection import Bones, chosen_parts, timeline_frames
from ..runtime.subject import Subject, check_unchanged
from .armature import ArmatureReading
from .button_settings import CleanBundle, CleanChoices, Limits, Prior
from .example_source import ExampleSource
from .examples import read_prior
from .keyed_strengths import keyed_strengths, read_strengths
from .markers import MarkerReading
from .report import clean_report, entry_of
from .solve_cleaning import Cleaned, Finish, Problem, Recordings, clean, names_of

MIN_OBSERVED_CONFIDENCE = 0.5
"""Confidence below which a key counts as generated. By definition of the confidence, at least
half of such joints are more than 5 degrees off."""
EASE_FRAMES = 5
"""Frames over which a cleaned range joins the frames outside it. Chosen by hand: 0.17 s at 30
Hz."""


@Sliced
def read_cleaning(
    scene: bpy.types.Scene, subject: bpy.types.Object, settings: CleanBundle
) -> "Steps[partial[Cleaned]]":
    """Read what an armature, or the markers below an object, play.

    Returns what is to be solved, which may be pickled.
    """
    choices = settings.choices
    chosen = chosen_parts(subject, choices.bones)  # what is selected at the press
    examples, found = yield from _read(Subject.of(scene, subject), choices)
    problem = _problem(found.raw, settings, examples)
    plants = choices.plant_feet and isinstance(found.raw, ArmatureTake)
    limits, contacts = found.limits(choices, chosen), found.contacts()
    finish = Finish(
        strengths=read_strengths(found.scene, settings, found.raw.grid.frames),
        keyed=keyed_strengths(
            found.scene, settings, has_parts=isinstance(found.raw, ArmatureTake)
        ),
        ease=ease_of(found.raw.grid),
        chosen=chosen,
        present=(yield from found.present(chosen)),
        limits=limits,
        planting=settings.planting if plants else None,
        contacts=contacts,
    )
    solution = yield from redo.stored_solution.steps(problem)
    return (partial if solution is None else ShortSolve)(clean, problem, finish, solution)


@Sliced
def write_cleaned(
    scene: bpy.types.Scene,
    subject: bpy.types.Object,
    settings: CleanBundle,
    cleaned: Cleaned,
    solved_digest: str | None = None,
) -> Steps[str]:
    """Write the result as a new action and assign it; return a message.

    Raises InvalidMotionError if the subject plays another motion than the one that was solved.
    """
    here = Subject.of(scene, subject)
    examples, found = yield from _read(here, settings.choices)
    problem = _problem(found.raw, settings, examples)
    yield from check_unchanged.steps(here.find()[1], solved_digest, problem)
    yield from redo.store_solution.steps(problem, cleaned.solution)
    types = yield from in_thread.steps(
        partial(key_types, cleaned.solution.recordings_of(problem), cleaned.solution.denoised)
    )
    frames = timeline_frames(here.find()[1], found.raw.frames)
    entry = yield from in_thread.steps(partial(entry_of, "denoise", settings, cleaned, frames))
    name, n_modified = yield from found.write(settings.choices, cleaned, types, entry)
    return clean_report(frames, cleaned, name, settings.choices.prior, n_modified)


def key_types(
    recordings: Recordings, denoised: tuple[Denoised, ...]
) -> dict[str, NDArray[np.uint8]]:
    """Paint the keys of each bone: what was filled or corrected is GENERATED, the rest not."""
    types: dict[str, NDArray[np.uint8]] = {}
    for recording, result in zip(recordings, denoised, strict=True):
        observed = recording.visible if isinstance(recording, Tracks) else recording.observed
        filled = ~observed | result.held
        flagged = filled | result.outliers | (result.confidence < MIN_OBSERVED_CONFIDENCE)
        for name, flags in zip(names_of(recording), flagged.T, strict=True):
            painted = np.where(flags, GENERATED, MEASURED).astype(np.uint8)
            types[name] = np.maximum(painted, types.get(name, MEASURED))
    return types


def _read(
    here: Subject, choices: CleanChoices
) -> Steps[tuple[ExampleSource, ArmatureReading | MarkerReading]]:
    """Read the examples, and then the take to clean."""
    scene, subject = here.find()
    if choices.prior is Prior.LIBRARY:
        examples = ExampleSource(library=library_prior(scene, subject))
    else:
        examples = yield from read_prior.steps(scene, subject, choices)
    scene, subject = here.find()
    kind = ArmatureReading if subject.type == "ARMATURE" else MarkerReading
    return examples, (yield from kind.of(scene, subject, choices))


def _problem(
    raw: ArmatureTake | MarkerTake, settings: CleanBundle, examples: ExampleSource
) -> Problem:
    choices = settings.choices
    learn_limits = choices.joint_limits is Limits.EXAMPLES and isinstance(raw, ArmatureTake)
    if learn_limits and choices.prior is not Prior.EXAMPLES:
        raise InvalidMotionError(
            "Joint limits can only be learned from examples. Choose examples to learn from."
        )
    return Problem(
        recordings=raw.recordings,
        settings=settings.denoising.at_full_strength(),
        examples=examples,
        learn_limits=learn_limits,
        unswap=choices.unswap and choices.bones is Bones.ALL and isinstance(raw, MarkerTake),
    )


def ease_of(grid: Grid) -> NDArray[np.float64]:
    """Return weights that rise from 0 and fall to 0 where the action continues outside."""
    n_frames = len(grid.frames)
    ramp = np.minimum((np.arange(n_frames) + 1.0) / (EASE_FRAMES + 1.0), 1.0)
    before, after = grid.joins
    return np.minimum(ramp if before else 1.0, ramp[::-1] if after else np.ones(n_frames))
