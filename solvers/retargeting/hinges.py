"""Axes about which the knees and elbows of the target bend."""

import numpy as np

from ..arrays import Array
from ..motion_fitting import FittedMotion
from ..motion_fitting.goals import hinge_axis
from ..rotations import rotate
from .body import HumanoidBody
from .limbs import Limb

MIN_HINGE_COSINE = 0.5
"""Cosine of the angle between the axis of a hinge and that of the T-pose. It guards straight
limbs, which seem to bend sideways or backward."""
HINGE_RAD = np.radians(1.0)
"""Radians by which hinges may pass their limits. It guards knees, elbows and toes against
bending the wrong way."""


def limb_hinge(body: HumanoidBody, fitted: FittedMotion, limb: Limb, usual: Array) -> Array:
    """Return the axis about which a limb bends, in the axes of its upper bone, shape (3,).

    It is the one that the motion shows. That of a limb which hardly bends is noise; if it is
    far from the `usual` one, which is that of the T-pose, the latter replaces it.
    """
    usual = rotate(body.alignment[limb[0]], usual)
    axis = hinge_axis(fitted, *limb[1:])
    return usual if axis is None or axis @ usual < MIN_HINGE_COSINE else axis
