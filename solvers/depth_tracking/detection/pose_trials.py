"""Poses that one picture may show: as its pixels were told, and as they may have been meant."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..body import COORDINATES, BodyModel
from ..forest import MIRRORED_PARTS, PARTS
from .labeled_fit import first_pose, fit_parts, fit_pixels
from .robust_parts import FoundParts

Array = NDArray[np.float64]

TOGETHER = ("Leg", "LegEnd", "Foot"), ("Shoulder", "UpperArm", "LowerArm", "Hand")
"""Ends of the names of parts whose left and right are exchanged together in a trial."""
HEADINGS = (0.0, np.pi / 3.0, -np.pi / 3.0, np.pi)
"""Radians by which the body may face elsewhere than was told."""
STRIDES = (0.35, -0.35)
"""Radians by which the left leg swings forward, and the right one back."""
BLIND_ROUNDS = 3


def trial_poses(
    body: BodyModel, parts: FoundParts, points: Array, shares: NDArray[np.float32]
) -> Iterator[Array]:
    """Yield poses (36,) that may be it.

    Parts of the left and of the right look alike, above all from the side, and are told apart
    worst. So the body is fitted to the parts as told, with left and right of legs and of arms
    exchanged, and then from several headings and strides to pixels of which nobody knows the
    side.

    Parameters
    ----------
    body : BodyModel
    parts : FoundParts
    points : shape (n, 3), metres
        Pixels to fit to.
    shares : shape (n, N_PARTS)
        How likely each is of each of the `PARTS`.
    """
    for order in exchange_orders():
        meant = parts.exchanged(order)
        pose = fit_parts(body, meant, first_pose(body, meant))
        yield fit_pixels(body, points, shares[:, order], pose)
    blind = 0.5 * (shares + shares[:, MIRRORED_PARTS])
    told = first_pose(body, parts)
    for heading in HEADINGS:
        for stride in STRIDES:
            start = told.copy()
            start[COORDINATES.index("yaw")] += heading
            start[COORDINATES.index("leftFemurX")] = stride
            start[COORDINATES.index("rightFemurX")] = -stride
            yield fit_pixels(body, points, blind, start, rounds=BLIND_ROUNDS)


def exchange_orders() -> list[NDArray[np.intp]]:
    """Return, for each trial, which part each of the `PARTS` is taken for."""
    orders = []
    for trial in range(2 ** len(TOGETHER)):
        ends = tuple(
            end
            for place, together in enumerate(TOGETHER)
            if trial >> place & 1
            for end in together
        )
        turned = np.array([part.endswith(ends) for part in PARTS])
        orders.append(np.where(turned, MIRRORED_PARTS, np.arange(len(PARTS))))
    return orders
