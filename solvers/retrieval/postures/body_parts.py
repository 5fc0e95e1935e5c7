"""Features of the five body parts, which are compared separately.

Separate parts allow a query for the movement of one arm, and a search without a part that was
not tracked.
"""

from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motion.humanoid import POSTURE_JOINTS


class BodyPart(Enum):
    """A part of the body; the order is that of the learned columns."""

    TRUNK = "trunk"
    LEFT_ARM = "left arm"
    RIGHT_ARM = "right arm"
    LEFT_LEG = "left leg"
    RIGHT_LEG = "right leg"


N_PARTS = len(BodyPart)
LIMBS = {
    BodyPart.TRUNK: ("hips", ("spine", "chest", "head")),
    BodyPart.LEFT_ARM: ("chest", ("leftUpperArm", "leftLowerArm", "leftHand")),
    BodyPart.RIGHT_ARM: ("chest", ("rightUpperArm", "rightLowerArm", "rightHand")),
    BodyPart.LEFT_LEG: ("hips", ("leftUpperLeg", "leftLowerLeg", "leftFoot")),
    BodyPart.RIGHT_LEG: ("hips", ("rightUpperLeg", "rightLowerLeg", "rightFoot")),
}
"""Reference joint and joints of each part. Fingers and toes are excluded, because they show
errors of the sensor rather than the movement."""
ROOTS = np.array([POSTURE_JOINTS.index(LIMBS[part][0]) for part in BodyPart])
JOINTS = np.array([
    [POSTURE_JOINTS.index(name) for name in LIMBS[part][1]] for part in BodyPart
])

VELOCITY_TIME_S = 0.08
"""Seconds: a velocity has the weight of the displacement in this time. Half and twice gain less
than 1 % (`make sensitivity`)."""
ROOT_VELOCITY_TIME_S = 0.3
"""Seconds, the same for the root velocity, which is a feature of the trunk. Half and twice gain
less than 1 % (`make sensitivity`)."""
TURNING_RADIUS_M = 0.5
"""Meters: converts the turning rate of the body to a velocity. Half and twice are no better
(`make sensitivity`)."""
N_PER_JOINT = 6
N_TRAVEL = 4
N_FEATURES = JOINTS.shape[1] * N_PER_JOINT + N_TRAVEL


def part_features(positions: Array, root_velocity: Array, frame_rate: float) -> Array:
    """Return the features of each part, shape (n_frames, 5, 22), meters.

    Positions and velocities of the joints relative to the reference joint of the part. The
    trunk also has the root velocity; the other parts have zeros there.

    Parameters
    ----------
    positions : shape (n_frames, 20, 3), meters
        Joints of the standard body without heading and root position.
    root_velocity : shape (n_frames, 4)
        Velocity of the hips, meters per second, and turning rate, radians per second.
    frame_rate : float, hertz
    """
    local = positions[:, JOINTS] - positions[:, ROOTS][:, :, None]
    velocities = np.zeros_like(local)
    if len(local) > 1:
        velocities = np.gradient(local, 1.0 / frame_rate, axis=0)
    features = np.zeros((len(local), N_PARTS, N_FEATURES))
    half = JOINTS.shape[1] * 3
    features[..., :half] = local.reshape(len(local), N_PARTS, half)
    features[..., half : 2 * half] = VELOCITY_TIME_S * velocities.reshape(
        len(local), N_PARTS, half
    )
    features[:, 0, 2 * half :] = (
        ROOT_VELOCITY_TIME_S * root_velocity * (1.0, 1.0, 1.0, TURNING_RADIUS_M)
    )
    return features


def part_coverage(observed: NDArray[np.bool_]) -> Array:
    """Return the tracked fraction of each part, shape (5,), 0 to 1.

    Parameters
    ----------
    observed : shape (n_frames, 20)
    """
    return np.asarray(observed[:, JOINTS].mean(axis=(0, 2)))
