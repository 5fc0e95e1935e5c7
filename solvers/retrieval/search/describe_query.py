"""What of a query is compared, and how much each part of the body counts in it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..index import Segments, Vocabulary, describe_segments
from ..postures import ClipPostures, part_coverage, part_reliability
from .find_settings import FindSettings

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class DescribedQuery:
    """A query, described.

    Attributes
    ----------
    features : shape (n_frames, 5, 8), metres
        What each part does, at 20 Hz.
    weights : shape (5,)
        How much each part counts.
    spans : Spans
        One: all of the query.
    """

    features: Array
    weights: Array
    spans: Segments


def describe_query(
    postures: ClipPostures, vocabulary: Vocabulary, settings: FindSettings
) -> DescribedQuery:
    """Describe a query in the words of a library.

    Raises
    ------
    InvalidMotionError
        No part is chosen, or nothing was tracked of those that are.
    """
    seen = np.isfinite(postures.positions).all(axis=-1)
    features = vocabulary.features(postures)
    weights = settings.part_weights(
        part_coverage(seen),
        part_reliability(seen, vocabulary.usual),
        vocabulary.activity(features),
    )
    whole = np.array([[0, len(features)]], dtype=np.int32)
    return DescribedQuery(features, weights, describe_segments(features, whole, vocabulary))
