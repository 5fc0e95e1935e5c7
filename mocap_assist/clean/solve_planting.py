"""Solve of the button Plant Feet: at contacts of the animator, or detected ones."""

from dataclasses import dataclass

from ...solvers.arrays import Array
from ...solvers.denoising import Planted, PlantSettings, plant_feet
from ...solvers.motion import Motion
from ...solvers.progress import Progress, unwatched
from .solve_cleaning import changed_joints


@dataclass(frozen=True, eq=False)
class Replanted:
    """Motion with planted feet, and the names of the joints that moved."""

    planted: Planted
    moved: frozenset[str]


def plant(
    body: Motion,
    contacts: Array | None,
    settings: PlantSettings,
    *,
    progress: Progress = unwatched,
) -> Replanted:
    """Plant the feet where the animator keyed contacts, or where they are detected."""
    planted = plant_feet(body, contacts, settings=settings, progress=progress)
    return Replanted(planted, changed_joints(body, planted.motion))
