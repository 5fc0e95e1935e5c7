"""Find out which feet stand, of the legs that were captured at all."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...motion import Motion
from ...motion.humanoid import HumanoidMap, detect_contacts
from ...rotations import angle_between
from .legs import SIDES, Leg

MAX_STILL_RAD = np.radians(0.02)
"""Rotation of the joints of a leg, in radians, below which the leg was not captured: who stands
still rotates a tenth of a degree. Chosen by hand."""


def detect_standing_feet(
    motion: Motion, humanoid_map: HumanoidMap, legs: Sequence[Leg]
) -> NDArray[np.bool_]:
    """Return the contacts of both feet, without those of a leg that was not captured.

    The leg of a suit that only captures the upper body hangs stiff from the hips. Its foot
    slides as the hips rotate; to plant it would flex the knee for nothing.
    """
    contacts = detect_contacts(motion, humanoid_map)
    hips = humanoid_map.indices(motion.skeleton).get("hips", 0)
    if _is_still(motion, hips):
        return contacts
    for leg in legs:
        if all(_is_still(motion, joint) for joint in leg.chain):
            contacts[:, SIDES.index(leg.side)] = False
    return contacts


def _is_still(motion: Motion, joint: int) -> bool:
    rotations = motion.rotations[:, joint]
    return bool((angle_between(rotations, rotations[:1]) < MAX_STILL_RAD).all())
