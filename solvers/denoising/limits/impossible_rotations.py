"""Which recorded turns no joint can make, though the estimate believes them."""

import numpy as np
from numpy.typing import NDArray

from ...motion import JointLimits, Motion
from ...signals import runs
from .clamp_to_limits import limit_excess

MIN_IMPOSSIBLE_EXCESS = np.radians(10.0)
"""A joint this much beyond its limits was not observed, whatever the recording says."""
MIN_FOLLOWED_EXCESS = np.radians(1.0)
"""An estimate this much beyond the limits follows what is impossible."""
MAX_EXCESS_FRACTION = 0.5
"""Limits that a joint is beyond in more than this share of the frames are not this body's."""


def find_impossible_rotations(
    recording: Motion, estimate: Motion, limits: JointLimits
) -> NDArray[np.bool_]:
    """Return where a joint was recorded far beyond its limits and the estimate follows it.

    What the estimate lays aside by itself is not worth a gap: a gap takes with it what the
    joint's other angles may tell.

    Parameters
    ----------
    recording, estimate : Motion
    limits : JointLimits

    Returns
    -------
    NDArray of bool, shape (n_frames, n_joints)
        Whole stretches of the recording.
    """
    impossible = limit_excess(recording, limits) > MIN_IMPOSSIBLE_EXCESS
    foreign = impossible.sum(axis=0) > MAX_EXCESS_FRACTION * recording.observed.sum(axis=0)
    followed = limit_excess(estimate, limits) > MIN_FOLLOWED_EXCESS
    result = np.zeros(impossible.shape, dtype=np.bool_)
    for joint in np.flatnonzero(impossible.any(axis=0) & ~foreign):
        for start, stop in runs(impossible[:, joint]):
            result[start:stop, joint] = followed[start:stop, joint].any()
    return result
