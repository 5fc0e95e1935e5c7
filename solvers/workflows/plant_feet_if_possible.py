"""Plant feet where there are feet, and say so where there are none."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..denoising import Planted, PlantSettings, plant_feet
from ..denoising.feet import foot_joints
from ..errors import InvalidMotionError
from ..motion import Motion, forward_kinematics
from ..motion.humanoid import detect_contacts
from ..progress import Progress, unwatched
from .keep_ankles import keep_ankles
from .level_toes import level_toes


class Footing(NamedTuple):
    """A motion, its feet planted if that could be done."""

    motion: Motion
    planted: Planted | None
    remarks: list[str]
    """Why they could not."""


def plant_feet_if_possible(
    motion: Motion,
    settings: PlantSettings | None,
    contacts: NDArray[np.bool_] | None = None,
    *,
    reliability: NDArray[np.float64] | None = None,
    progress: Progress = unwatched,
) -> Footing:
    """Plant feet; without settings, or without legs, leave them as they are.

    With the reliability of each joint, shape (n_frames, n_joints), toes that were lost are laid
    down first, and ankles that were trusted and still are left within 3 cm of their place.
    """
    if settings is None:
        return Footing(motion, None, [])
    try:
        laid = motion
        if reliability is not None and motion.observed.all():
            standing = detect_contacts(motion) if contacts is None else contacts
            laid = level_toes(motion, reliability, standing)
        planted = plant_feet(laid, contacts, settings=settings, progress=progress)
    except InvalidMotionError as error:
        return Footing(motion, None, [f"Feet are left as they are. {error}"])
    if reliability is not None:
        kept = keep_ankles(planted.motion, laid, reliability, planted.contacts)
        slide = planted.slide_after + _more_slide(planted, kept)
        planted = replace(planted, motion=kept, slide_after=slide)
    return Footing(planted.motion, planted, [])


def _more_slide(planted: Planted, kept: Motion) -> float:
    """Return by how much more feet slide that were brought back, metres."""
    feet = foot_joints(kept)
    if feet is None:
        return 0.0
    ways = []
    for motion in (planted.motion, kept):
        level = forward_kinematics(motion).positions[:, feet, :2]
        steps = np.linalg.norm(np.diff(level, axis=0), axis=-1).min(axis=-1)
        ways.append(steps[planted.contacts[1:] & planted.contacts[:-1]].sum())
    return float(max(ways[1] - ways[0], 0.0))
