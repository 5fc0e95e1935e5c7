"""Plant feet where there are feet, and say so where there are none."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..denoising import Planted, PlantSettings, plant_feet
from ..errors import InvalidMotionError
from ..motion import Motion
from ..progress import Progress, unwatched


class Footing(NamedTuple):
    """A motion, its feet planted if that could be done."""

    motion: Motion
    planted: Planted | None
    remarks: list[str]
    """Why they could not."""


def try_to_plant(
    motion: Motion,
    settings: PlantSettings | None,
    contacts: NDArray[np.bool_] | None = None,
    *,
    progress: Progress = unwatched,
) -> Footing:
    """Plant feet; without settings, or without legs, leave them as they are."""
    if settings is None:
        return Footing(motion, None, [])
    try:
        planted = plant_feet(motion, contacts, settings=settings, progress=progress)
    except InvalidMotionError as error:
        return Footing(motion, None, [f"Feet are left as they are. {error}"])
    return Footing(planted.motion, planted, [])
