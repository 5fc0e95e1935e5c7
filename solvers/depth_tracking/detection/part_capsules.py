"""Positions of the pixel classes (parts) on the capsules of a body."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..body import CAPSULE_SEGMENTS, CAPSULES, BodyModel
from ..forest import N_PARTS, PARTS, SPLIT_SEGMENTS


def _part_spans() -> tuple[NDArray[np.intp], Array]:
    """Return the capsule of each part, and its interval (0 to 1) on the capsule axis."""
    capsules = np.zeros(N_PARTS, dtype=np.intp)
    spans = np.tile([0.0, 1.0], (N_PARTS, 1))
    for index, part in enumerate(PARTS):
        capsules[index] = CAPSULES.index(part.removesuffix("End"))
        if part.endswith("End"):
            spans[index] = 0.5, 1.0
        elif part.endswith(SPLIT_SEGMENTS):
            spans[index] = 0.0, 0.5
    return capsules, spans


PART_CAPSULES, PART_SPANS = _part_spans()
"""Index of each part's capsule (N_PARTS,), and its interval on the axis (N_PARTS, 2)."""
PART_SEGMENTS = CAPSULE_SEGMENTS[PART_CAPSULES]
"""Index of the segment that each part belongs to (N_PARTS,)."""

CAPSULE_OF_PART = np.zeros((N_PARTS, len(CAPSULES)), dtype=np.float32)
"""One-hot capsule of each part: part probabilities @ CAPSULE_OF_PART are per capsule."""
CAPSULE_OF_PART[np.arange(N_PARTS), PART_CAPSULES] = 1.0


def part_axes(body: BodyModel) -> Array:
    """Return both ends of each part's axis in its segment's frame, (N_PARTS, 2, 3), meters."""
    starts, stops = body.capsule_ends[PART_CAPSULES].swapaxes(0, 1)
    fractions = PART_SPANS[:, :, np.newaxis]
    axes: Array = starts[:, np.newaxis] * (1.0 - fractions) + stops[:, np.newaxis] * fractions
    return axes


def part_radii(body: BodyModel) -> Array:
    """Return the radii of each part, (N_PARTS, 2), meters: lateral and front to back."""
    radii: Array = body.radii[PART_CAPSULES]
    return radii
