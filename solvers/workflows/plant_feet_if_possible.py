"""Plant the feet of a motion if it has legs, and report why if it has none."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..denoising import Planted, PlantSettings, plant_feet
from ..denoising.feet import find_foot_joints
from ..errors import InvalidMotionError
from ..motion import Motion, forward_kinematics
from ..motion.humanoid import detect_contacts
from ..progress import Progress, unwatched
from .flatten_toes import flatten_toes
from .restore_ankles import restore_ankles


class PlantingResult(NamedTuple):
    """A motion with planted feet, if planting was possible."""

    motion: Motion
    planted: Planted | None
    remarks: list[str]
    """Why planting was not possible."""


def plant_feet_if_possible(
    motion: Motion,
    settings: PlantSettings | None,
    contacts: NDArray[np.bool_] | None = None,
    *,
    reliability: NDArray[np.float64] | None = None,
    progress: Progress = unwatched,
) -> PlantingResult:
    """Plant feet; without settings or without legs, return the motion unchanged.

    With the reliability of each joint, shape (n_frames, n_joints), missing toes are flattened
    first. Reliable resting ankles then stay within 3 cm of their observed position.
    """
    if settings is None:
        return PlantingResult(motion, None, [])
    try:
        flattened = motion
        if reliability is not None and motion.observed.all():
            standing_contacts = detect_contacts(motion) if contacts is None else contacts
            flattened = flatten_toes(motion, reliability, standing_contacts)
        planted = plant_feet(flattened, contacts, settings=settings, progress=progress)
    except InvalidMotionError as error:
        return PlantingResult(motion, None, [f"Feet were not planted. {error}"])
    if reliability is not None:
        restored = restore_ankles(planted.motion, flattened, reliability, planted.contacts)
        slide = planted.slide_after + _added_slide(planted, restored)
        planted = replace(planted, motion=restored, slide_after=slide)
    return PlantingResult(planted.motion, planted, [])


def _added_slide(planted: Planted, restored: Motion) -> float:
    """Return the additional slide of feet whose ankles were restored, meters."""
    feet = find_foot_joints(restored)
    if feet is None:
        return 0.0
    distances = []
    for motion in (planted.motion, restored):
        ground_path = forward_kinematics(motion).positions[:, feet, :2]
        steps = np.linalg.norm(np.diff(ground_path, axis=0), axis=-1).min(axis=-1)
        distances.append(steps[planted.contacts[1:] & planted.contacts[:-1]].sum())
    return float(max(distances[1] - distances[0], 0.0))
