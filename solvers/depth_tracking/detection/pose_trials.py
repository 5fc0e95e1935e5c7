"""Pose hypotheses for one depth image: as classified, and with left and right swapped."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..body import COORDINATES, BodyModel
from ..forest import MIRRORED_PARTS, PARTS
from .labeled_fit import first_pose, fit_parts, fit_pixels
from .robust_parts import FoundParts

SWAP_GROUPS = ("Leg", "LegEnd", "Foot"), ("Shoulder", "UpperArm", "LowerArm", "Hand")
"""Name suffixes of parts that are swapped together in a trial."""
HEADING_OFFSETS = (0.0, np.pi / 3.0, -np.pi / 3.0, np.pi)
"""Heading offsets from the detected heading, radians: starts of trials, by definition ahead, to
both sides and back."""
STRIDES = (0.35, -0.35)
"""Forward rotation of the left thigh and backward rotation of the right one, radians: starts of
trials, by definition with either leg in front."""
UNSIDED_ROUNDS = 3
"""Number of rounds of a fit without side labels. It bounds the run time: most of these trials
are discarded."""


def trial_poses(
    body: BodyModel, parts: FoundParts, points: Array, probabilities: NDArray[np.float32]
) -> Iterator[Array]:
    """Yield pose hypotheses (36,).

    Left and right parts look similar, mainly from the side, and are the most confused classes.
    So the body is fitted to the parts as classified, and with left and right of legs and arms
    swapped. Then it is fitted from several headings and strides to pixels without side labels.

    Parameters
    ----------
    body : BodyModel
    parts : FoundParts
    points : shape (n, 3), meters
        Observed points.
    probabilities : shape (n, N_PARTS)
        Probability of each of the `PARTS` for each point.
    """
    for order in swap_orders():
        swapped = parts.swap_parts(order)
        pose = fit_parts(body, swapped, first_pose(body, swapped))
        yield fit_pixels(body, points, probabilities[:, order], pose)
    unsided = 0.5 * (probabilities + probabilities[:, MIRRORED_PARTS])
    detected = first_pose(body, parts)
    for heading in HEADING_OFFSETS:
        for stride in STRIDES:
            start = detected.copy()
            start[COORDINATES.index("yaw")] += heading
            start[COORDINATES.index("leftFemurX")] = stride
            start[COORDINATES.index("rightFemurX")] = -stride
            yield fit_pixels(body, points, unsided, start, rounds=UNSIDED_ROUNDS)


def swap_orders() -> list[NDArray[np.intp]]:
    """Return the part indices, (N_PARTS,), of each trial, with some groups swapped."""
    orders = []
    for trial in range(2 ** len(SWAP_GROUPS)):
        ends = tuple(
            end
            for index, group in enumerate(SWAP_GROUPS)
            if trial >> index & 1
            for end in group
        )
        is_swapped = np.array([part.endswith(ends) for part in PARTS])
        orders.append(np.where(is_swapped, MIRRORED_PARTS, np.arange(len(PARTS))))
    return orders
