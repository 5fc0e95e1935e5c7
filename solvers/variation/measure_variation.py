"""How different motions are from each other [ZH14, eq. 4.5]."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from ..errors import InvalidMotionError
from ..motion import Motion, warp
from .align_examples import ALIGNMENT_RATE_HZ, positions_in_body_frame


def measure_variation(motions: Sequence[Motion]) -> float:
    """Return the mean distance of pairs of motions after dynamic time warping, in metres.

    Per step of the path and joint; joints are told as the actor faces, relative to the hips,
    20 times a second.

    Parameters
    ----------
    motions : Motion, two or more, of one rig

    Raises
    ------
    InvalidMotionError
        There are fewer than two, or rigs differ.
    """
    if len(motions) < 2:
        raise InvalidMotionError("One motion has no variation; give at least two.")
    bodies = [
        positions_in_body_frame(motion)[:: max(round(motion.frame_rate / ALIGNMENT_RATE_HZ), 1)]
        for motion in motions
    ]
    return float(np.mean([warp(one, other).cost for one, other in combinations(bodies, 2)]))
