"""Which way the palms face in a rest pose, by the knuckles."""

import numpy as np
from numpy.typing import NDArray

from ...rotations import inverse, multiply, quaternion_from_rotation_vector, rotate
from ..skeletons import Skeleton

Array = NDArray[np.float64]

ASLANT, TURNED = np.radians([30.0, 60.0])
"""Palms that are turned less than the first from facing down, in rests as most rigs have them,
stay as they are: knuckles lie a little aslant in all hands. From the second on they are turned
back wholly, in between partly, so that nearly equal rests are treated nearly alike."""
ALIKE = np.radians([30.0, 60.0])
"""By how much both hands may differ, wholly and at all."""
ALONG_ARM = np.array([1.0, 0.0, 0.0])
FINGERS = ("Little", "Ring", "Middle")


def with_palms_down(alignment: Array, skeleton: Skeleton, joints: dict[str, int]) -> Array:
    """Return the alignment of arms whose palms face down, as the T-pose has them.

    Bones alone do not tell how a hand is turned about the arm. Its knuckles do: in the T-pose
    they lie one behind the other, the index finger in front. Where those of both hands are
    turned from there, alike and by more than a little (palms that face forward), hands are
    taken to be turned, and forearms by half, as forearms twist.

    Parameters
    ----------
    alignment : shape (n_joints, 4)
        World rotations from the T-pose to the rest pose, whatever the palms.
    skeleton : Skeleton
    joints : dict of role to joint
    """
    left, right = (_roll(alignment, skeleton, joints, side) for side in ("left", "right"))
    if left is None or right is None:
        return alignment
    apart = (right - left + np.pi) % (2.0 * np.pi) - np.pi
    share = _rising(min(abs(left), abs(right)), ASLANT, TURNED)
    share *= 1.0 - _rising(abs(apart), *ALIKE)
    if share == 0.0:
        return alignment
    turned, roll = alignment.copy(), share * (left + 0.5 * apart)
    half, whole = (
        quaternion_from_rotation_vector(part * roll * ALONG_ARM) for part in (0.5, 1.0)
    )
    for side in ("left", "right"):
        hand = skeleton.subtree(joints[f"{side}Hand"])
        if f"{side}LowerArm" in joints:
            arm = [j for j in skeleton.subtree(joints[f"{side}LowerArm"]) if j not in hand]
            turned[arm] = multiply(turned[arm], half)
        turned[hand] = multiply(turned[hand], whole)
    return turned


def _roll(
    alignment: Array, skeleton: Skeleton, joints: dict[str, int], side: str
) -> float | None:
    """Return by how much a hand is turned about the arm, radians, if its knuckles are known."""
    index = joints.get(f"{side}IndexProximal")
    others = (joints.get(f"{side}{finger}Proximal") for finger in FINGERS)
    other = next((joint for joint in others if joint is not None), None)
    hand = joints.get(f"{side}Hand")
    if index is None or other is None or hand is None:
        return None
    rest = skeleton.rest_positions
    backwards = rotate(inverse(alignment[hand]), rest[other] - rest[index])
    return float(np.arctan2(backwards[2], backwards[1]))


def _rising(value: float, start: float, stop: float) -> float:
    """Return 0 up to `start`, 1 from `stop` on, smoothly in between."""
    share = float(np.clip((value - start) / (stop - start), 0.0, 1.0))
    return share * share * (3.0 - 2.0 * share)
