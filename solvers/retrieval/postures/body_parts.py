"""The five parts of the body that are compared each for itself, and what of them is told.

Apart, they let an animator ask for what one arm does, and let a search go on without a part
that was not tracked.
"""

from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ...motion.humanoid import POSTURE_JOINTS

Array = NDArray[np.float64]


class BodyPart(Enum):
    """What can be compared; the order is that of the columns of what is learned."""

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
"""From where each part's joints are measured, and which they are. Fingers and toes tell a
sensor's habits rather than the movement."""
ROOTS = np.array([POSTURE_JOINTS.index(LIMBS[part][0]) for part in BodyPart])
JOINTS = np.array([
    [POSTURE_JOINTS.index(name) for name in LIMBS[part][1]] for part in BodyPart
])

VELOCITY_TIME_S = 0.08
"""Seconds: a speed counts as much as the way made in them."""
ROOT_VELOCITY_TIME_S = 0.3
"""Seconds, the same for how the whole body travels; it is told with the trunk."""
TURNING_RADIUS_M = 0.5
"""Metres that turn the turning of the body into a speed."""
N_PER_JOINT = 6
N_TRAVEL = 4
N_FEATURES = JOINTS.shape[1] * N_PER_JOINT + N_TRAVEL


def part_features(positions: Array, course: Array, frame_rate: float) -> Array:
    """Return what each part does, shape (n_frames, 5, 22), metres.

    Positions and speeds of its joints relative to where it hangs; after those of the trunk
    come the speeds of the whole body, which are zero for other parts.

    Parameters
    ----------
    positions : shape (n_frames, 20, 3), metres
        Of the standard body without heading and place.
    course : shape (n_frames, 4)
        Speeds of the hips, metres per second, and of turning, radians per second.
    frame_rate : float, hertz
    """
    local = positions[:, JOINTS] - positions[:, ROOTS][:, :, None]
    speeds = np.zeros_like(local)
    if len(local) > 1:
        speeds = np.gradient(local, 1.0 / frame_rate, axis=0)
    told = np.zeros((len(local), N_PARTS, N_FEATURES))
    half = JOINTS.shape[1] * 3
    told[..., :half] = local.reshape(len(local), N_PARTS, half)
    told[..., half : 2 * half] = VELOCITY_TIME_S * speeds.reshape(len(local), N_PARTS, half)
    told[:, 0, 2 * half :] = ROOT_VELOCITY_TIME_S * course * (1.0, 1.0, 1.0, TURNING_RADIUS_M)
    return told


def part_coverage(seen: NDArray[np.bool_]) -> Array:
    """Return how much of each part was tracked, shape (5,), 0 to 1.

    Parameters
    ----------
    seen : shape (n_frames, 20)
    """
    return np.asarray(seen[:, JOINTS].mean(axis=(0, 2)))
