"""Priors of a pose, independent of the image."""

import re

import numpy as np

from ...arrays import Array
from .coordinates import COORDINATES, LOWER_LIMITS, ROOT, UPPER_LIMITS
from .normal_equations import PoseEquations

_LIMB_PATTERN = re.compile("Humerus|Radius|Femur|Tibia")
_ANKLE = "Ankle"
LIMIT_WEIGHT = 1.0
"""Weight per square radian beyond the joint limits, in fits to joints and to depth pixels.
Chosen by hand; `make sensitivity` varies it."""
MAX_STEP = 0.5
"""Maximum change of a coordinate in one step of these fits, radians or meters. Chosen by hand;
`make sensitivity` varies it."""


def stay_near(pose: Array, expected: Array, weights: Array) -> PoseEquations:
    """Return equations that pull the coordinates to expected values.

    With a prediction from the two previous frames this is the prior of [WZC12] eq. 7 and 18.
    With the previous pose it is the smoothness term of [LOU12] eq. 3.15.

    Parameters
    ----------
    pose, expected : shape (36,)
    weights : shape (36,)
        Weights of the squares.
    """
    change = expected - pose
    return PoseEquations(np.diag(weights), weights * change, 0.5 * float(weights @ change**2))


def predict_pose(poses: list[Array], weight: float) -> Array:
    """Predict the next pose by linear extrapolation.

    Parameters
    ----------
    poses : list of shape (36,)
        The previous poses, in temporal order.
    weight : float
        Fraction of the last movement that continues: 1 constant velocity, 0 no movement.
    """
    if len(poses) < 2:
        return poses[-1]
    expected: Array = poses[-1] + weight * (poses[-1] - poses[-2])
    return expected


def joint_limits(pose: Array, weight: float) -> PoseEquations:
    """Return equations that pull coordinates of a pose, (36,), back inside the soft limits."""
    correction = np.clip(pose, LOWER_LIMITS, UPPER_LIMITS) - pose
    weights = np.where(correction != 0.0, weight, 0.0)
    return PoseEquations(
        np.diag(weights), weights * correction, 0.5 * float(weights @ correction**2)
    )


_LIMB_WEIGHT = 0.1
"""Weight of a limb's coordinates, relative to those of the trunk. Half and twice are no better
(`make sensitivity`)."""
_STANCE_WEIGHTS = np.array([
    0.0 if name in ROOT or name.endswith(_ANKLE)
    else _LIMB_WEIGHT if _LIMB_PATTERN.search(name) else 1.0
    for name in COORDINATES
])  # fmt: skip
_IS_ANKLE = np.char.endswith(COORDINATES, _ANKLE).astype(float)


def natural_stance(pose: Array, weight: float, ankle_weight: float) -> PoseEquations:
    """Return equations that pull a pose, (36,), to upright standing, mainly trunk and head.

    A separate weight keeps feet perpendicular to the shanks.
    """
    weights = weight * _STANCE_WEIGHTS + ankle_weight * _IS_ANKLE
    return PoseEquations(np.diag(weights), -weights * pose, 0.5 * float(weights @ pose**2))
