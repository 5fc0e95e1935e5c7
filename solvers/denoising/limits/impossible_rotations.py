"""Which recorded turns no joint can make, though the estimate believes them."""

import numpy as np
from numpy.typing import NDArray

from ...motion import JointLimits, Motion
from ...signals import runs
from .clamp_to_limits import limit_excess

IMPOSSIBLE = np.radians(10.0)
"""A joint this much beyond its limits was not observed, whatever the recording says."""
BELIEVED = np.radians(1.0)
"""An estimate this much beyond the limits follows what is impossible."""
MOSTLY = 0.5
"""Limits that a joint is beyond in more than this share of the frames are not this body's."""


def impossible_turns(
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
    far = limit_excess(recording, limits) > IMPOSSIBLE
    foreign = far.sum(axis=0) > MOSTLY * recording.observed.sum(axis=0)
    believed = limit_excess(estimate, limits) > BELIEVED
    found = np.zeros(far.shape, dtype=np.bool_)
    for joint in np.flatnonzero(far.any(axis=0) & ~foreign):
        for start, stop in runs(far[:, joint]):
            found[start:stop, joint] = believed[start:stop, joint].any()
    return found
