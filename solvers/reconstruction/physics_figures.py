"""What there is to say about a simulation."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion, forward_kinematics

OTHER_GROUND = 0.25
"""Metres, for legs of 0.9 m, by which the feet's ground may differ from the one given."""


def mean_distance(motion: Motion, other: Motion, joints: Sequence[int]) -> float:
    """Return the mean distance in metres between the same joints of two motions."""
    here, there = (
        forward_kinematics(each).positions[:, list(joints)] for each in (motion, other)
    )
    return float(np.linalg.norm(there - here, axis=-1).mean())


def told(
    followed: NDArray[np.bool_], given_up: bool, ground: float, under_feet: float, size: float
) -> str:
    """Say where the body could follow, and whether the ground is where the feet stand."""
    n_lost, n_frames = int((~followed).sum()), len(followed)
    sentences = []
    if given_up:
        sentences.append(
            "The simulated body could not follow the take, which is left as it is."
        )
    elif n_lost:
        first = int(np.flatnonzero(~followed)[0])
        sentences.append(
            f"The simulated body could not follow in {n_lost} of {n_frames} frames, the first"
            f" of them {first}; there the take is left as it is."
        )
    else:
        sentences.append("The simulated body followed the whole take.")
    if abs(under_feet - ground) > OTHER_GROUND * size:
        sentences.append(
            f"The take stands at a height of {under_feet:.2f} m, the ground is at"
            f" {ground:.2f} m: choose the ground under the feet if that is wrong."
        )
    return " ".join(sentences)
