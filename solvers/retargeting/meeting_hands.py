"""Let hands that meet in the source meet."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TOUCHING, APART = 0.15, 0.4
"""Parts of the arm's length: hands nearer to each other than the first meet, and beyond the
second they have nothing to do with each other."""
STRAIGHTEST = 0.999
"""Part of its length to which an arm may stretch for hands to meet."""


class Arms(NamedTuple):
    """Both arms of the target, left and right."""

    shoulders: Array
    """Where the upper arms begin, shape (2, n_frames, 3), metres."""
    hands: Array
    """Where the hands would be if each arm were alone, shape (2, n_frames, 3), metres."""
    lengths: Array
    """Shape (2,), metres."""


def meeting_hands(arms: Arms, apart: Array) -> Array:
    """Return the places of the hands, shape (2, n_frames, 3), metres.

    Parameters
    ----------
    arms : Arms
    apart : shape (n_frames, 3), metres
        From the right hand to the left in the source, scaled by the arms.

    Returns
    -------
    NDArray
        Hands that are close in the source are `apart` from each other, around the middle of
        where they would be alone; nearer to the shoulders where those are too broad for it.
    """
    distance = np.linalg.norm(apart, axis=1) / arms.lengths.mean()
    share = np.clip((APART - distance) / (APART - TOUCHING), 0.0, 1.0)
    share = (share * share * (3.0 - 2.0 * share))[:, None]
    left, right = arms.hands
    correction = 0.5 * share * (apart - (left - right))
    hands = np.stack([left + correction, right - correction])
    inwards = (arms.shoulders - hands).mean(axis=0)
    inwards /= np.maximum(np.linalg.norm(inwards, axis=1, keepdims=True), 1e-12)
    lacking = [
        way_into_reach(hand - shoulder, inwards, STRAIGHTEST * length)
        for hand, shoulder, length in zip(hands, arms.shoulders, arms.lengths, strict=True)
    ]
    return np.asarray(hands + share * np.maximum(*lacking)[:, None] * inwards)


def way_into_reach(way: Array, direction: Array, reach: Array | float) -> Array:
    """Return how far a point must go in a direction to be within reach, shape (n_frames,).

    Parameters
    ----------
    way : shape (n_frames, 3), metres
        From where the limb begins to the point.
    direction : shape (n_frames, 3) or (3,), unit vectors
    reach : metres, one for all frames or shape (n_frames,)

    Returns
    -------
    NDArray
        Not negative; where no way leads within reach, to where the point is nearest.
    """
    along = (way * direction).sum(axis=1)
    beside = np.maximum((way * way).sum(axis=1) - along**2, 0.0)
    room = np.sqrt(np.maximum(reach**2 - beside, 0.0))
    return np.asarray(np.maximum(-along - room, 0.0))
