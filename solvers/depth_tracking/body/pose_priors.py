"""What is asked of a pose before the picture is looked at."""

import re

import numpy as np
from numpy.typing import NDArray

from .coordinates import COORDINATES, LOWER_LIMITS, ROOT, UPPER_LIMITS
from .normal_equations import PoseEquations

Array = NDArray[np.float64]

_LIMB = re.compile("Humerus|Radius|Femur|Tibia")
_ANKLE = "Ankle"


def stay_near(pose: Array, expected: Array, weights: Array) -> PoseEquations:
    """Ask the coordinates to be as expected.

    With `expected` what the two frames before foretell this is the prior of [WZC12] eq. 7 and
    18; with the frame before, the smoothness of [LOU12] eq. 3.15.

    Parameters
    ----------
    pose, expected : shape (36,)
    weights : shape (36,)
        Of the squares.
    """
    change = expected - pose
    return PoseEquations(np.diag(weights), weights * change, 0.5 * float(weights @ change**2))


def predict_pose(poses: list[Array], trust: float) -> Array:
    """Return the pose that goes on from the last ones as they went.

    Parameters
    ----------
    poses : list of shape (36,)
        The frames before, the last one last.
    trust : float
        Share of the last movement that goes on: 1 constant velocity, 0 standing still.
    """
    if len(poses) < 2:
        return poses[-1]
    expected: Array = poses[-1] + trust * (poses[-1] - poses[-2])
    return expected


def joint_limits(pose: Array, weight: float) -> PoseEquations:
    """Ask coordinates beyond the soft limits to come back, the more the farther beyond."""
    back = np.clip(pose, LOWER_LIMITS, UPPER_LIMITS) - pose
    weights = np.where(back != 0.0, weight, 0.0)
    return PoseEquations(np.diag(weights), weights * back, 0.5 * float(weights @ back**2))


_LIMB_SHARE = 0.1
_EASE = np.array([
    0.0 if name in ROOT or name.endswith(_ANKLE)
    else _LIMB_SHARE if _LIMB.search(name) else 1.0
    for name in COORDINATES
])  # fmt: skip
_IS_ANKLE = np.char.endswith(COORDINATES, _ANKLE).astype(float)


def natural_stance(pose: Array, weight: float, ankle_weight: float) -> PoseEquations:
    """Ask the joints to be as in upright standing: the trunk, head and clavicles above all.

    Feet are held square to the shanks by a weight of their own.
    """
    weights = weight * _EASE + ankle_weight * _IS_ANKLE
    return PoseEquations(np.diag(weights), -weights * pose, 0.5 * float(weights @ pose**2))
