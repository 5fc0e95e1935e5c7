"""Describe a query by features, part weights and codewords."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ..index import Segments, Vocabulary, describe_segments
from ..postures import ClipPostures, part_coverage, part_reliability
from .find_settings import FindSettings


@dataclass(frozen=True, eq=False)
class DescribedQuery:
    """Features and weights of a query.

    Attributes
    ----------
    features : shape (n_frames, 5, 8), meters
        Features of each part at 20 Hz.
    weights : shape (5,)
        Weight of each part.
    segments : Segments
        One segment: the complete query.
    """

    features: Array
    weights: Array
    segments: Segments


def describe_query(
    postures: ClipPostures, vocabulary: Vocabulary, settings: FindSettings
) -> DescribedQuery:
    """Describe a query with the vocabulary of a library.

    Raises
    ------
    InvalidMotionError
        No part is selected, or none of the selected parts was tracked.
    """
    observed = np.isfinite(postures.positions).all(axis=-1)
    features = vocabulary.features(postures)
    weights = settings.part_weights(
        part_coverage(observed),
        part_reliability(observed, vocabulary.posture_distribution),
        vocabulary.activity(features),
    )
    frames = np.array([[0, len(features)]], dtype=np.int32)
    return DescribedQuery(features, weights, describe_segments(features, frames, vocabulary))
