"""Plant the feet of a motion if it has legs, and report why if it has none."""

from typing import NamedTuple

import numpy as np

from ...arrays import Array, Flags
from ...denoising import Planted, PlantSettings, plant_feet
from ...errors import InvalidMotionError
from ...feet import find_legs
from ...motion import Motion
from ...motion.humanoid import MIN_JOINT_RELIABILITY, SIDES, detect_contacts
from ...progress import Progress, unwatched
from .flatten_toes import flatten_toes

RELIABLE_WEIGHT = 5.0
"""Weight of the path of such an ankle, relative to that of others. Chosen by hand: 1 fails
`test_reliable_ankle_is_planted_near_its_rest_position`."""


class PlantingResult(NamedTuple):
    """A motion with planted feet, if planting was possible."""

    motion: Motion
    planted: Planted | None
    remarks: list[str]
    """Why planting was not possible, or what went wrong."""


def plant_feet_if_possible(
    motion: Motion,
    settings: PlantSettings | None,
    contacts: Flags | Array | None = None,
    *,
    reliability: Array | None = None,
    progress: Progress = unwatched,
) -> PlantingResult:
    """Plant feet; without settings or without legs, return the motion unchanged.

    `contacts` are those of `plant_feet`, which detects them where they are NaN.

    With the reliability of each joint, shape (n_frames, n_joints), missing toes are flattened
    first, and reliable ankles keep to their path five times as firmly.
    """
    if settings is None:
        return PlantingResult(motion, None, [])
    try:
        flattened = motion
        if reliability is not None and motion.observed.all():
            flattened = flatten_toes(motion, reliability, _foot_contacts(motion, contacts))
        weights = None if reliability is None else _ankle_weights(motion, reliability)
        planted = plant_feet(
            flattened, contacts, settings=settings, ankle_weights=weights, progress=progress
        )
    except InvalidMotionError as error:
        return PlantingResult(motion, None, [f"Feet were not planted. {error}"])
    remarks = [f"{remark}." for remark in planted.remarks]
    return PlantingResult(planted.motion, planted, remarks)


def _foot_contacts(motion: Motion, contacts: Flags | Array | None) -> Flags:
    """Return the contacts of both feet, shape (n_frames, 2), detected where not given."""
    given = np.full((motion.n_frames, len(SIDES)), np.nan)
    if contacts is not None:
        given = np.asarray(contacts, dtype=np.float64)[:, : len(SIDES)]
    is_missing = np.isnan(given)
    found = detect_contacts(motion) if is_missing.any() else np.zeros_like(is_missing)
    return np.asarray(np.where(is_missing, found, given != 0.0))


def _ankle_weights(motion: Motion, reliability: Array) -> Array:
    """Return how firmly each ankle keeps its path, shape (n_frames, 2)."""
    weights = np.ones((motion.n_frames, len(SIDES)))
    for leg in find_legs(motion.skeleton):
        is_reliable = np.nan_to_num(reliability[:, leg.ankle]) > MIN_JOINT_RELIABILITY
        weights[is_reliable, SIDES.index(leg.side)] = RELIABLE_WEIGHT
    return weights
