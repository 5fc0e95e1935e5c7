"""Whether the detector's probabilities of contact are the fractions of frames in contact."""

from collections.abc import Iterable, Iterator

import numpy as np

from solvers.arrays import Array, Flags
from solvers.motion import contact_probabilities
from solvers.motion.humanoid import probabilities_of_points

from ..shared.tables import table
from .force_plates import weighed_walks
from .labeled_clips import at_rate, labeled_clips
from .made_takes import made_takes

N_BINS = 10
EDGES = ((0.0, 0.1), (0.1, 0.3), (0.3, 0.5), (0.5, 0.7), (0.7, 0.9), (0.9, 1.0))
"""Bins of probability whose fractions are shown."""


def calibration_table(rates: Iterable[float]) -> str:
    """Return the expected calibration error by source and frame rate, and fractions by bin."""
    rows = {
        f"{rate:g} Hz, {source}": [
            f"{_expected_error(probability, contact):.3f}",
            *(_fraction(probability, contact, *edges) for edges in EDGES),
        ]
        for rate in rates
        for source, probability, contact in _sources(rate)
    }
    header = [
        "take",
        "expected calibration error",
        *(f"{low:g} to {high:g}" for low, high in EDGES),
    ]
    title = "**Calibration: frames of a foot in contact, by the probability of contact**"
    return f"{title}\n\n{table(header, rows)}\n"


def _sources(rate: float) -> Iterator[tuple[str, Array, Flags]]:
    """Return probabilities and contacts of all frames of feet whose contact is known."""
    weighed = [
        (probabilities_of_points(walk.feet, rate)[walk.known], walk.contacts[walk.known])
        for walk in weighed_walks(rate)
    ]
    if weighed:
        yield "force plates", *_joined(weighed)
    made = made_takes(rate).values()
    yield (
        "made takes",
        *_joined((contact_probabilities(take.motion), take.contacts) for take in made),
    )
    labeled = (at_rate(*clip, rate, 0.0) for clip in labeled_clips().values())
    yield (
        "labeled captures",
        *_joined((contact_probabilities(motion), label) for motion, label in labeled),
    )


def _joined(pairs: Iterable[tuple[Array, Flags]]) -> tuple[Array, Flags]:
    probabilities, contacts = zip(*pairs, strict=True)
    return (
        np.concatenate([one.ravel() for one in probabilities]),
        np.concatenate([one.ravel() for one in contacts]),
    )


def _expected_error(probability: Array, contact: Flags) -> float:
    """Return the mean distance of probability and fraction in bins of a tenth."""
    bins = np.minimum((probability * N_BINS).astype(int), N_BINS - 1)
    total = sum(
        abs((probability - contact)[bins == number].sum()) for number in np.unique(bins)
    )
    return float(total / len(probability))


def _fraction(probability: Array, contact: Flags, low: float, high: float) -> str:
    inside = (probability >= low) & ((probability < high) | (high == 1.0))
    return f"{contact[inside].mean():.2f}" if inside.any() else "-"
