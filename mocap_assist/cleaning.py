"""What the button Clean reads from the scene, and what it writes back."""

from dataclasses import replace
from functools import partial
from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ..solvers.denoising import Denoised
from ..solvers.errors import InvalidMotionError
from ..solvers.motion import Tracks
from . import redo
from .clean_choices import CleanChoices, CleanSettings, Limits, Prior
from .clean_report import clean_report, entry_of
from .examples import read_prior
from .jobs.cleaning import Cleaned, Finish, Problem, Recordings, clean, names_of
from .jobs.job import Quick
from .scene import history
from .scene.armature_read import read_take
from .scene.armature_write import check_writable, count_modified, put_to_use, write_take
from .scene.compat import Source
from .scene.contacts import animators_contacts, write_contacts
from .scene.curves import GENERATED, MEASURED
from .scene.limits import read_limits
from .scene.take import ArmatureTake
from .selection import chosen_bones, played_source
from .subject import check_unchanged

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


def read_cleaning(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: CleanSettings
) -> "partial[Cleaned]":
    """Read what an armature plays; return what is to be solved, which may be pickled."""
    choices = settings.choices
    found = _read(scene, armature, choices)
    limits = None
    if choices.joint_limits is Limits.CONSTRAINTS:
        limits = read_limits(found.armature, found.raw, found.bones)
    problem = _problem(scene, found, settings)
    finish = Finish(
        strength=settings.denoising.strength,
        ease=_ease(found.raw),
        chosen=found.bones,
        present=_present(scene, found),
        limits=limits,
        planting=settings.planting if choices.plant_feet else None,
        contacts=animators_contacts(found.played, found.raw.frames),
    )
    solution = redo.recall(problem)
    return (partial if solution is None else Quick)(clean, problem, finish, solution)


def write_cleaned(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    settings: CleanSettings,
    cleaned: Cleaned,
    asked: str | None = None,
) -> str:
    """Write the result as a new action and put it to use; return a sentence about it.

    Raises InvalidMotionError if the armature plays something else than what was `asked`, a
    fingerprint of the problem.
    """
    found = _read(scene, armature, settings.choices)
    problem = _problem(scene, found, settings)
    check_unchanged(armature, asked, problem)
    redo.remember(problem, cleaned.solution)
    take = found.raw.with_recordings(cleaned.recordings)
    n_modified = count_modified(found.played, cleaned.moved)
    types = key_types(found.raw, cleaned.solution.denoised)
    action, slot = write_take(found.armature, found.played, take, cleaned.moved, types)
    if cleaned.planted is not None:
        contacts = cleaned.planted.contacts
        detected = animators_contacts(found.played, take.frames) is None
        write_contacts(found.armature, action, slot, take.frames, contacts, detected=detected)
    history.record(action, found.played, entry_of("denoise", settings, cleaned))
    put_to_use(found.armature, action, slot, settings.choices.result_as)
    return clean_report(found.raw, cleaned, action.name, n_modified)


def key_types(
    raw: ArmatureTake, denoised: tuple[Denoised, ...]
) -> dict[str, NDArray[np.uint8]]:
    """Paint the keys of each bone: what was filled or corrected is GENERATED, the rest not."""
    types: dict[str, NDArray[np.uint8]] = {}
    for recording, result in zip(raw.recordings, denoised, strict=True):
        seen = recording.visible if isinstance(recording, Tracks) else recording.observed
        unsure = ~seen | result.outliers | (result.confidence < UNSURE)
        for name, flags in zip(names_of(recording), unsure.T, strict=True):
            painted = np.where(flags, GENERATED, MEASURED).astype(np.uint8)
            types[name] = np.maximum(painted, types.get(name, MEASURED))
    return types


def _read(scene: bpy.types.Scene, armature: bpy.types.Object, choices: CleanChoices) -> Reading:
    check_writable(armature)
    bones = chosen_bones(armature, choices.bones)
    played = played_source(armature)
    recorded = history.raw_of(played[0]) or played
    raw = read_take(armature, scene, choices.frame_range, recorded)
    return Reading(armature, recorded, played, raw, bones)


def _problem(scene: bpy.types.Scene, found: Reading, settings: CleanSettings) -> Problem:
    choices = settings.choices
    learn_limits = choices.joint_limits is Limits.EXAMPLES
    if learn_limits and choices.prior is not Prior.EXAMPLES:
        raise InvalidMotionError(
            "Joint limits can only be learned from examples: choose those to learn from."
        )
    return Problem(
        recordings=found.raw.recordings,
        settings=replace(settings.denoising, strength=1.0),
        examples=read_prior(scene, found.armature, choices),
        learn_limits=learn_limits,
    )


def _present(scene: bpy.types.Scene, found: Reading) -> Recordings | None:
    """What an earlier result shows of the bones that stay, if it differs from the recording."""
    everything = len(found.bones) == len(found.raw.rig.bones)
    if everything or found.played == found.recorded:
        return None
    grid = found.raw.grid
    present = read_take(found.armature, scene, source=found.played, grid=grid)
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
