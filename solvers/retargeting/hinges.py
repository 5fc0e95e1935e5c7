"""Axes about which the knees and elbows of the target bend."""

import numpy as np

from ..arrays import Array
from ..motion_fitting import FittedMotion
from ..motion_fitting.goals import MIN_BEND, bone_directions
from ..rotations import normalize, rotate
from ..signals import smooth_gaussian
from .body import HumanoidBody
from .limbs import LIMB_SMOOTHING_S, Limb


def limb_hinge(body: HumanoidBody, fitted: FittedMotion, limb: Limb, rest_axis: Array) -> Array:
    """Return the axis about which a limb bends, in the axes of its upper bone, (n_frames, 3).

    It is the one that the motion shows, and the more the `rest_axis` of the T-pose, the
    straighter the limb is. A limb that bends backward keeps the latter.
    """
    rest_axis = rotate(body.alignment[limb[0]], rest_axis)
    shown = np.cross(*bone_directions(fitted, *limb[1:]))
    backward = np.minimum(shown @ rest_axis, 0.0)
    shown = shown - backward[:, None] * rest_axis
    smooth = smooth_gaussian(shown, LIMB_SMOOTHING_S * fitted.motion.frame_rate)
    return normalize(smooth + MIN_BEND * rest_axis)
