"""Solve of the button Vary: learn from examples, and draw new motions."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...solvers.arrays import Array
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
from ..retarget.solve_retargeting import (
    Retargeted,
    RetargetProblem,
    StagedMotion,
    retarget_clips,
)
from ..scene.controls import TargetRig

SIMILAR_VARIANTS = "Variants are nearly identical: add source actions or raise Amount."
SHEET = StickFigureSettings(n_figures=10, height=140)


@dataclass(frozen=True, eq=False)
class Controls:
    """Controls of a rig with constrained bones; variants of its body are retargeted to them."""

    rig: TargetRig
    settings: RetargetSettings
    origin: Array
    """Position of the armature on the ground, shape (3,), meters."""
    rotation: Array
    """Its rotation about the vertical, shape (4,)."""


@dataclass(frozen=True, eq=False)
class VaryProblem:
    """Input of Vary."""

    examples: tuple[Motion, ...]
    n_variants: int
    settings: VarySettings
    planting: PlantSettings | None
    """None does not plant feet."""
    frame_rate: float
    """Hertz, of the scene, which limits the number of keys."""
    controls: Controls | None = None
    """Controls of a control rig; the joints of its examples are then named by roles."""


class Varied(NamedTuple):
    """New motions with thumbnails, and remarks to report."""

    motions: tuple[Motion, ...]
    pictures: tuple[Pixels, ...]
    remarks: tuple[str, ...]
    keys: Retargeted = ()
    """Of a control rig: its channels for each motion."""


def vary(problem: VaryProblem, *, progress: Progress = unwatched) -> Varied:
    """Synthesize variants that start at the position and heading of the first example."""
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
    for index, (motion, is_loop) in enumerate(zip(made.motions, made.loops, strict=True)):
        progress(0.8 + 0.1 * index / len(made.motions), "Drawing")
        normalized = normalize_postures(postures_from_motion(motion), motion.frame_rate)
        angle = float(first.headings[0] - normalized.headings[0])
        aligned = move_to(motion, normalized.hip_positions[0], angle, first.hip_positions[0])
        resample_variant = resample_loop if is_loop else resample
        finer = motion.frame_rate > problem.frame_rate
        motions.append(resample_variant(aligned, problem.frame_rate) if finer else aligned)
        pictures.append(thumbnail(normalized.postures))
    remarks = (*made.remarks, SIMILAR_VARIANTS) if are_similar(motions) else made.remarks
    keys = _control_channels(motions, problem.controls, within(progress, 0.9, 1.0))
    return Varied(tuple(motions), tuple(pictures), remarks, keys)


def _control_channels(
    motions: Sequence[Motion], controls: Controls | None, progress: Progress
) -> Retargeted:
    """Return the channels of a control rig's bones for each motion of its body."""
    if controls is None:
        return ()
    clips = tuple(
        StagedMotion(motion, controls.origin, controls.rotation) for motion in motions
    )
    names = motions[0].skeleton.names
    roles = HumanoidMap({name: name for name in names if name in HUMANOID_ROLES})
    problem = RetargetProblem(clips, roles, controls.rig, controls.settings)
    return retarget_clips(problem, progress=progress)


def are_similar(motions: Sequence[Motion]) -> bool:
    """Whether there are several motions, and no two of them differ."""
    first, *others = motions
    return bool(others) and all(
        each.n_frames == first.n_frames and np.allclose(each.rotations, first.rotations)
        for each in others
    )


def move_to(motion: Motion, pivot: Array, angle: float, target: Array) -> Motion:
    """Rotate a motion about the vertical through a pivot, and move the pivot to a position.

    Parameters
    ----------
    motion : Motion
    pivot, target : shape (3,), meters
        Heights stay.
    angle : float, radians
    """
    about = np.array([np.cos(angle / 2.0), 0.0, 0.0, np.sin(angle / 2.0)])
    level = np.array([1.0, 1.0, 0.0])
    positions = rotate(about, motion.root_positions - level * pivot) + level * target
    rotations = motion.rotations.copy()
    rotations[:, 0] = multiply(about, rotations[:, 0])
    return motion.with_poses(rotations, positions)


def draw_sheet(
    motions: Sequence[tuple[str, Motion]], path: str, *, progress: Progress = unwatched
) -> int:
    """Draw named motions one below the other to a PNG file; return how many."""
    rows = []
    for index, (name, motion) in enumerate(motions):
        progress(index / len(motions), f"Drawing {name}")
        rows.append(draw_stick_figures({name: motion}, SHEET))
    stack_pictures(rows).save(path)
    return len(rows)
