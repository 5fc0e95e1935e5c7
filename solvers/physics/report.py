"""Describe the result of a simulation."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion, forward_kinematics
from .body_surface import MAX_HOVER_M


def mean_distance(motion: Motion, other: Motion, joints: Sequence[int]) -> float:
    """Return the mean distance in meters between the same joints of two motions."""
    positions, other_positions = (
        forward_kinematics(each).positions[:, list(joints)] for each in (motion, other)
    )
    return float(np.linalg.norm(other_positions - positions, axis=-1).mean())


def describe_result(followed: NDArray[np.bool_], smoothing: float) -> str:
    """Describe how often the body followed, and how much smoothing (seconds) that required.

    `followed`, shape (n_frames,), is False in all frames if the result is the take.
    """
    n_failed, n_frames = int((~followed).sum()), len(followed)
    if not followed.any():
        return "The simulated body could not follow the take, which is unchanged."
    smoothed = f" That required smoothing by {smoothing:.2g} s." if smoothing else ""
    if not n_failed:
        return f"The simulated body followed the complete take.{smoothed}"
    return (
        f"The simulated body could not follow in {n_failed} of {n_frames} frames; there the"
        f" take is unchanged.{smoothed}"
    )


def describe_first_failure(followed: NDArray[np.bool_], frames: Sequence[float]) -> str:
    """Describe which of the `frames` of a take the body failed to follow first.

    `followed` has the shape (n_frames,). The text is empty if all are True, or none.
    """
    if followed.all() or not followed.any():
        return ""
    frame = frames[int(followed.argmin())]
    return f"The first frame that the body could not follow is {frame:.7g}."


def is_near_ground(ground: float, under_feet: float, size: float) -> bool:
    """Return whether the height under the feet is near the ground's, for this body size."""
    return abs(under_feet - ground) <= MAX_HOVER_M * size


def describe_ground(ground: float, under_feet: float, size: float, given: float | None) -> str:
    """Describe a ground that is not under the take, or not at the given height.

    `given` is None if the ground need not be at a given height. The text is empty if all is as
    expected.
    """
    if given is not None and not is_near_ground(given, ground, size):
        return (
            f" The take stands at a height of {ground:.2f} m, far from {given:.2f} m: the"
            " ground is assumed to be under its feet."
        )
    if is_near_ground(ground, under_feet, size):
        return ""
    return (
        f" The take stands at a height of {under_feet:.2f} m, the ground is at {ground:.2f} m."
        " If that is wrong, set the ground to be under the feet."
    )
