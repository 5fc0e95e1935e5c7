"""Plant the feet of a motion if it has legs, and report why if it has none."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..denoising import Planted, PlantSettings, plant_feet
from ..errors import InvalidMotionError
from ..feet import find_legs
from ..motion import Motion
from ..motion.humanoid import MIN_JOINT_RELIABILITY, SIDES, detect_contacts
from ..progress import Progress, unwatched
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
    contacts: NDArray[np.bool_] | None = None,
    *,
    reliability: NDArray[np.float64] | None = None,
    progress: Progress = unwatched,
) -> PlantingResult:
    """Plant feet; without settings or without legs, return the motion unchanged.

    With the reliability of each joint, shape (n_frames, n_joints), missing toes are flattened
    first, and reliable ankles keep to their path five times as firmly.
    """
    if settings is None:
        return PlantingResult(motion, None, [])
    try:
        flattened = motion
        if reliability is not None and motion.observed.all():
            standing_contacts = detect_contacts(motion) if contacts is None else contacts
            flattened = flatten_toes(motion, reliability, standing_contacts)
        weights = None if reliability is None else _ankle_weights(motion, reliability)
        planted = plant_feet(
            flattened, contacts, settings=settings, ankle_weights=weights, progress=progress
        )
    except InvalidMotionError as error:
        return PlantingResult(motion, None, [f"Feet were not planted. {error}"])
    remarks = [f"{remark}." for remark in planted.remarks]
    return PlantingResult(planted.motion, planted, remarks)


def _ankle_weights(motion: Motion, reliability: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how firmly each ankle keeps its path, shape (n_frames, 2)."""
    weights = np.ones((motion.n_frames, len(SIDES)))
    for leg in find_legs(motion.skeleton):
        is_reliable = np.nan_to_num(reliability[:, leg.ankle]) > MIN_JOINT_RELIABILITY
        weights[is_reliable, SIDES.index(leg.side)] = RELIABLE_WEIGHT
    return weights
