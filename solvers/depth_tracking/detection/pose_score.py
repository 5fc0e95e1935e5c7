"""Score of a pose, from depth and from the classified parts of the pixels."""

import numpy as np

from ..forest import PixelParts
from ..terms import Hypothesis, Observation
from ..tracking import MAX_DEPTH_ERROR_M
from .part_capsules import CAPSULE_OF_PART


def pose_score(
    hypothesis: Hypothesis, observation: Observation, pixels: PixelParts, label_weight: float
) -> tuple[float, float]:
    """Return the score of a pose, 0 to 1, and the fraction of overlapping pixels.

    The score averages over the union of observed and rendered pixels. Each pixel scores by its
    depth error, and by the forest's probability of the rendered part.

    Parameters
    ----------
    hypothesis : Hypothesis
        The rendered body.
    observation : Observation
    pixels : PixelParts
        Classified parts of the observed pixels, in their order.
    label_weight : float
        Weight of the forest; depth has weight 1.
    """
    image = hypothesis.image
    observed = observation.flat[image.pixels]
    both = observed > 0.0
    union = len(observation.pixels) + len(image.pixels) - int(both.sum())
    depth_errors = np.abs(observed[both] - image.depths[both])
    closeness = np.maximum(0.0, 1.0 - depth_errors / MAX_DEPTH_ERROR_M)
    capsule_probabilities = pixels.probabilities @ CAPSULE_OF_PART
    label_scores = capsule_probabilities[
        observation.index_image[image.pixels[both]], image.capsules[both]
    ]
    label_scores = np.where(closeness > 0.0, label_scores, 0.0)
    score = (closeness.sum() + label_weight * label_scores.sum()) / (
        (1.0 + label_weight) * max(union, 1)
    )
    return float(score), float((closeness > 0.0).sum() / max(union, 1))
