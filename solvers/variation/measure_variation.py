"""Measure how different motions are from each other [ZH14, eq. 4.5]."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from ..errors import InvalidMotionError
from ..motion import Motion, warp
from .align_examples import ALIGNMENT_RATE_HZ, positions_in_body_frame


def measure_variation(motions: Sequence[Motion]) -> float:
    """Return the mean distance of pairs of motions after dynamic time warping, in meters.

    The mean is over path steps and joints. Joint positions are in the actor's body frame, at 20
    frames a second.

    Parameters
    ----------
    motions : Motion, two or more, of one rig

    Raises
    ------
    InvalidMotionError
        There are fewer than two motions, or rigs differ.
    """
    if len(motions) < 2:
        raise InvalidMotionError("One motion has no variation; give at least two.")
    bodies = [
        positions_in_body_frame(motion)[:: max(round(motion.frame_rate / ALIGNMENT_RATE_HZ), 1)]
        for motion in motions
    ]
    return float(
        np.mean([warp(first, second).cost for first, second in combinations(bodies, 2)])
    )
