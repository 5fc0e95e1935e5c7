"""How well a body in a pose explains a depth picture and what a forest told of its pixels."""

import numpy as np
from numpy.typing import NDArray

from ..forest import PixelParts
from ..terms import Hypothesis, Observation
from .part_capsules import CAPSULE_OF_PART

Array = NDArray[np.float64]

FARTHEST = 0.1
"""Metres: depths farther apart do not fit at all."""


def pose_score(
    hypothesis: Hypothesis, observation: Observation, pixels: PixelParts, label_weight: float
) -> tuple[float, float]:
    """Return the score of a pose, 0 to 1, and the share of pixels that overlap.

    Over pixels that see the body or should see it, each fits by how near the depths are, and
    by how likely the forest holds the part that should be seen there.

    Parameters
    ----------
    hypothesis : Hypothesis
        The body in its pose.
    observation : Observation
    pixels : PixelParts
        What the forest told of the observed pixels, in their order.
    label_weight : float
        How much the forest counts; depth counts 1.
    """
    picture = hypothesis.picture
    seen = observation.flat[picture.pixels]
    both = seen > 0.0
    union = len(observation.pixels) + len(picture.pixels) - int(both.sum())
    apart = np.abs(seen[both] - picture.depths[both])
    near = np.maximum(0.0, 1.0 - apart / FARTHEST)
    likely = pixels.shares @ CAPSULE_OF_PART
    told = likely[observation.index_picture[picture.pixels[both]], picture.capsules[both]]
    told = np.where(near > 0.0, told, 0.0)
    score = (near.sum() + label_weight * told.sum()) / ((1.0 + label_weight) * max(union, 1))
    return float(score), float((near > 0.0).sum() / max(union, 1))
