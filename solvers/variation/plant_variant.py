"""Plant the feet of a variant."""

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..feet import PlantSettings, plant_feet
from ..motion import Motion
from ..motion.humanoid import detect_contacts
from ..progress import Progress, Remark
from .loops import extract_middle_cycle, repeat_loop

N_CYCLES = 3
"""Number of cycles of a loop to plant together. By definition: the middle one of three
continues at both ends."""


def plant_variant(
    motion: Motion,
    contacts: NDArray[np.bool_] | None,
    loops: bool,
    planting: PlantSettings,
    progress: Progress,
) -> Motion:
    """Return a variant with planted feet; unchanged, with a remark, if it has no feet.

    Feet stand where those of the examples, contacts of (n_frames, 2), or of the variant itself
    do. A loop stays a loop.
    """
    complete = motion
    if loops:
        complete = repeat_loop(motion, N_CYCLES)
        if contacts is not None:
            contacts = np.concatenate([*[contacts[:-1]] * N_CYCLES, contacts[-1:]])
    if contacts is not None:
        contacts = contacts | detect_contacts(complete)
    try:
        planted = plant_feet(complete, contacts, settings=planting, progress=progress).motion
    except InvalidMotionError as error:
        progress(1.0, Remark(f"Feet were not planted. {error}"))
        return motion
    return extract_middle_cycle(planted, motion) if loops else planted
