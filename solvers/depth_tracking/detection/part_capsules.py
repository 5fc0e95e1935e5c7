"""Where the parts that pixels are told apart by lie on the capsules of a body."""

import numpy as np
from numpy.typing import NDArray

from ..body import CAPSULE_SEGMENTS, CAPSULES, BodyModel
from ..forest import N_PARTS, PARTS, SPLIT_SEGMENTS

Array = NDArray[np.float64]


def _spans() -> tuple[NDArray[np.intp], Array]:
    """Return each part's capsule and which stretch of its axis, 0 to 1, the part is."""
    capsules = np.zeros(N_PARTS, dtype=np.intp)
    spans = np.tile([0.0, 1.0], (N_PARTS, 1))
    for place, part in enumerate(PARTS):
        capsules[place] = CAPSULES.index(part.removesuffix("End"))
        if part.endswith("End"):
            spans[place] = 0.5, 1.0
        elif part.endswith(SPLIT_SEGMENTS):
            spans[place] = 0.0, 0.5
    return capsules, spans


PART_CAPSULES, PART_SPANS = _spans()
"""Index of each part's capsule (N_PARTS,), and the stretch of its axis (N_PARTS, 2)."""
PART_SEGMENTS = CAPSULE_SEGMENTS[PART_CAPSULES]
"""Index of the segment that each part belongs to (N_PARTS,)."""

CAPSULE_OF_PART = np.zeros((N_PARTS, len(CAPSULES)), dtype=np.float32)
"""1 where a part is of a capsule: shares of parts @ CAPSULE_OF_PART are those of capsules."""
CAPSULE_OF_PART[np.arange(N_PARTS), PART_CAPSULES] = 1.0


def part_axes(body: BodyModel) -> Array:
    """Return both ends of each part's axis in its segment's frame, (N_PARTS, 2, 3), metres."""
    starts, stops = body.capsule_ends[PART_CAPSULES].swapaxes(0, 1)
    shares = PART_SPANS[:, :, np.newaxis]
    axes: Array = starts[:, np.newaxis] * (1.0 - shares) + stops[:, np.newaxis] * shares
    return axes


def part_radii(body: BodyModel) -> Array:
    """Return how thick each part is, (N_PARTS, 2), metres: across, and from front to back."""
    radii: Array = body.radii[PART_CAPSULES]
    return radii
