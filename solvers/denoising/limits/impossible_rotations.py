"""Find recorded rotations that no joint can reach although the estimate follows them."""

import numpy as np
from numpy.typing import NDArray

from ...motion import JointLimits, Motion
from ...signals import find_runs
from .clamp_to_limits import limit_excess

MIN_IMPOSSIBLE_EXCESS = np.radians(10.0)
"""Radians: a joint this far beyond its limits was not really observed. Half and twice are no
better (`make sensitivity`)."""
MAX_EXCESS_FRACTION = 0.5
"""Limits that a joint exceeds in a larger fraction of the frames belong to another body. Half
and twice are no better (`make sensitivity`)."""


def find_impossible_rotations(
    recording: Motion, estimate: Motion, limits: JointLimits
) -> NDArray[np.bool_]:
    """Return where a joint was recorded far beyond its limits and the estimate follows it.

    Samples that the estimate already rejects stay in the take: a gap would also remove the
    information in the joint's other angles.

    Parameters
    ----------
    recording, estimate : Motion
    limits : JointLimits

    Returns
    -------
    NDArray of bool, shape (n_frames, n_joints)
        Complete intervals of the recording.
    """
    impossible = limit_excess(recording, limits) > MIN_IMPOSSIBLE_EXCESS
    foreign = impossible.sum(axis=0) > MAX_EXCESS_FRACTION * recording.observed.sum(axis=0)
    followed = limit_excess(estimate, limits) > 0.0
    result = np.zeros(impossible.shape, dtype=np.bool_)
    for joint in np.flatnonzero(impossible.any(axis=0) & ~foreign):
        for start, stop in find_runs(impossible[:, joint]):
            result[start:stop, joint] = followed[start:stop, joint].any()
    return result
