"""How far each tracked joint can be trusted [SHJT13, section IV]."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Reliability:
    """How far each joint can be trusted at each frame, 0 to 1, and why.

    Attributes
    ----------
    combined, behaviour, kinematics, tracking : shape (n_frames, n_joints)
        The last three are the terms of [SHJT13], eq. 4, 6 and 7; a term that the recording
        tells nothing of is 1.
    """

    combined: NDArray[np.float64]
    behaviour: NDArray[np.float64]
    kinematics: NDArray[np.float64]
    tracking: NDArray[np.float64]
