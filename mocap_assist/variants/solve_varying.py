"""Solve of the button Vary."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...solvers.denoising import PlantSettings
from ...solvers.motion import HUMANOID_ROLES, HumanoidMap, Motion, resample
from ...solvers.motion.humanoid import normalize_postures, postures_from_motion
from ...solvers.pictures import StickFigureSettings, draw_stick_figures, stack_pictures
from ...solvers.progress import Progress, unwatched, within
from ...solvers.retargeting import RetargetSettings
from ...solvers.rotations import multiply, rotate
from ...solvers.variation import VarySettings, resample_loop
from ...solvers.workflows import vary_motions
from ..library.thumbnails import Pixels, thumbnail
from ..retarget.solve_retargeting import Clip, Retargeted, RetargetProblem, retarget_clips
from ..scene.controls import TargetRig

Array = NDArray[np.float64]
ALIKE = "Variants are nearly identical: add source actions or raise Amount."
SHEET = StickFigureSettings(n_figures=10, height=140)


@dataclass(frozen=True, eq=False)
class Controls:
    """How a rig is keyed whose bones constraints move: variants of its body are retargeted."""

    rig: TargetRig
    settings: RetargetSettings
    origin: Array
    """Where the armature stands on the ground, shape (3,), meters."""
    rotation: Array
    """How it is turned about the vertical, shape (4,)."""


@dataclass(frozen=True, eq=False)
class VaryProblem:
    """All that Vary depends on."""

    examples: tuple[Motion, ...]
    n_variants: int
    settings: VarySettings
    planting: PlantSettings | None
    """None leaves feet as they are."""
    frame_rate: float
    """Hertz, of the scene: more keys than frames would only fill the file."""
    controls: Controls | None = None
    """Of a control rig; the joints of its examples are then named by roles."""


class Varied(NamedTuple):
    """New motions, each with a picture, and what is to be said of them."""

    motions: tuple[Motion, ...]
    pictures: tuple[Pixels, ...]
    remarks: tuple[str, ...]
    keys: Retargeted = ()
    """Of a control rig: its channels for each motion."""


def vary(problem: VaryProblem, *, progress: Progress = unwatched) -> Varied:
    """Make variants that begin where the first example does, facing the same way."""
    made = vary_motions(
        problem.examples,
        problem.n_variants,
        settings=problem.settings,
        planting=problem.planting,
        progress=within(progress, 0.0, 0.8),
    )
    first = normalize_postures(
        postures_from_motion(problem.examples[0]), problem.examples[0].frame_rate
    )
    motions, pictures = [], []
    for place, (motion, is_loop) in enumerate(zip(made.motions, made.loops, strict=True)):
        progress(0.8 + 0.1 * place / len(made.motions), "Drawing")
        seen = normalize_postures(postures_from_motion(motion), motion.frame_rate)
        turn = float(first.headings[0] - seen.headings[0])
        there = moved(motion, seen.places[0], turn, first.places[0])
        seen_as = resample_loop if is_loop else resample
        finer = motion.frame_rate > problem.frame_rate
        motions.append(seen_as(there, problem.frame_rate) if finer else there)
        pictures.append(thumbnail(seen.postures))
    remarks = (*made.remarks, ALIKE) if are_alike(motions) else made.remarks
    keys = _keyed(motions, problem.controls, within(progress, 0.9, 1.0))
    return Varied(tuple(motions), tuple(pictures), remarks, keys)


def _keyed(
    motions: Sequence[Motion], controls: Controls | None, progress: Progress
) -> Retargeted:
    """Return the channels of a control rig's bones for each motion of its body."""
    if controls is None:
        return ()
    clips = tuple(Clip(motion, controls.origin, controls.rotation) for motion in motions)
    names = motions[0].skeleton.names
    roles = HumanoidMap({name: name for name in names if name in HUMANOID_ROLES})
    problem = RetargetProblem(clips, roles, controls.rig, controls.settings)
    return retarget_clips(problem, progress=progress)


def are_alike(motions: Sequence[Motion]) -> bool:
    """Whether there are several motions, and no two of them differ."""
    first, *others = motions
    return bool(others) and all(
        each.n_frames == first.n_frames and np.allclose(each.rotations, first.rotations)
        for each in others
    )


def moved(motion: Motion, pivot: Array, turn: float, place: Array) -> Motion:
    """Turn a motion about the vertical through a point, which comes above a place.

    Parameters
    ----------
    motion : Motion
    pivot, place : shape (3,), meters
        Heights stay.
    turn : float, radians
    """
    about = np.array([np.cos(turn / 2.0), 0.0, 0.0, np.sin(turn / 2.0)])
    level = np.array([1.0, 1.0, 0.0])
    positions = rotate(about, motion.root_positions - level * pivot) + level * place
    rotations = motion.rotations.copy()
    rotations[:, 0] = multiply(about, rotations[:, 0])
    return motion.with_poses(rotations, positions)


def draw_sheet(
    motions: Sequence[tuple[str, Motion]], path: str, *, progress: Progress = unwatched
) -> int:
    """Draw named motions one below the other to a PNG file; return how many."""
    rows = []
    for place, (name, motion) in enumerate(motions):
        progress(place / len(motions), f"Drawing {name}")
        rows.append(draw_stick_figures({name: motion}, SHEET))
    stack_pictures(rows).save(path)
    return len(rows)
