"""Palm orientation in a rest pose, from the knuckles."""

import numpy as np

from ...arrays import Array
from ...rotations import inverse, multiply, quaternion_from_rotation_vector, rotate
from ...signals import smoothstep
from ..skeletons import Skeleton
from .tables import SIDES

MIN_PALM_ROLL_RAD, MAX_PALM_ROLL_RAD = np.radians([30.0, 60.0])
"""Roll of the palms from facing down below which they are unchanged, since all knuckles are a
little oblique, and from which the roll is fully removed. The transition is smooth."""
PALM_ROLL_DIFFERENCE_RAD = np.radians([30.0, 60.0])
"""Difference between both hands, radians, up to which the roll is fully removed, and not at
all. Chosen by hand as `MIN_PALM_ROLL_RAD`: it guards hands that rest unlike each other."""
ALONG_ARM = np.array([1.0, 0.0, 0.0])
FINGERS = ("Little", "Ring", "Middle")


def with_palms_down(alignment: Array, skeleton: Skeleton, joints: dict[str, int]) -> Array:
    """Return the alignment with the palms of the T-pose facing down.

    The bones of an arm do not determine the roll of the hand; its knuckles do. In the T-pose
    they are in one row, the index finger in front. If the knuckles of both hands have a
    similar, large roll (palms that face forward), it is removed from the hands, and half of it
    from the forearms.

    Parameters
    ----------
    alignment : shape (n_joints, 4)
        World rotations from the T-pose to the rest pose, without regard to the palms.
    skeleton : Skeleton
    joints : dict of role to joint
    """
    left, right = (_roll(alignment, skeleton, joints, side) for side in SIDES)
    if left is None or right is None:
        return alignment
    difference = (right - left + np.pi) % (2.0 * np.pi) - np.pi
    fraction = smoothstep(min(abs(left), abs(right)), MIN_PALM_ROLL_RAD, MAX_PALM_ROLL_RAD)
    fraction *= 1.0 - smoothstep(abs(difference), *PALM_ROLL_DIFFERENCE_RAD)
    if fraction == 0.0:
        return alignment
    result, roll = alignment.copy(), fraction * (left + 0.5 * difference)
    half, full = (
        quaternion_from_rotation_vector(fraction * roll * ALONG_ARM) for fraction in (0.5, 1.0)
    )
    for side in SIDES:
        hand = skeleton.subtree(joints[f"{side}Hand"])
        if f"{side}LowerArm" in joints:
            arm = [j for j in skeleton.subtree(joints[f"{side}LowerArm"]) if j not in hand]
            result[arm] = multiply(result[arm], half)
        result[hand] = multiply(result[hand], full)
    return result


def _roll(
    alignment: Array, skeleton: Skeleton, joints: dict[str, int], side: str
) -> float | None:
    """Return the roll of a hand about the arm, radians; None without knuckles."""
    index = joints.get(f"{side}IndexProximal")
    others = (joints.get(f"{side}{finger}Proximal") for finger in FINGERS)
    other = next((joint for joint in others if joint is not None), None)
    hand = joints.get(f"{side}Hand")
    if index is None or other is None or hand is None:
        return None
    rest = skeleton.rest_positions
    backwards = rotate(inverse(alignment[hand]), rest[other] - rest[index])
    return float(np.arctan2(backwards[2], backwards[1]))
