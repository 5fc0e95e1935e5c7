"""Which pixels of a drawn body and of an observed actor can be compared, and which cannot."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .hypothesis import Hypothesis
from .observation import Observation

Array = NDArray[np.float64]
Integers = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class PixelGroups:
    """The regions of [WZC12] figure 4.

    Attributes
    ----------
    comparable : int, shape (n,)
        G: visible points of the body (by index) whose pixel sees the actor at nearly the same
        depth.
    off_actor : int
        B1: visible points whose pixel does not see the actor.
    too_near : int
        B2, type 3: visible points much nearer than what their pixel observed.
    too_far : int
        B2, type 4: visible points much farther than what their pixel observed.
    uncovered : int
        B3: pixels that see the actor but not the body.
    """

    comparable: Integers
    off_actor: Integers
    too_near: Integers
    too_far: Integers
    uncovered: Integers


def group_pixels(hypothesis: Hypothesis, observation: Observation, limit: float) -> PixelGroups:
    """Tell pixels apart; depths farther apart than `limit`, metres, show different parts."""
    drawn = hypothesis.picture.pixels
    observed = observation.flat[drawn]
    on_actor = observed > 0.0
    difference = hypothesis.picture.depths - observed
    uncovered = observation.pixels[hypothesis.index_picture[observation.pixels] < 0]
    return PixelGroups(
        np.flatnonzero(on_actor & (np.abs(difference) <= limit)),
        np.flatnonzero(~on_actor),
        np.flatnonzero(on_actor & (difference < -limit)),
        np.flatnonzero(on_actor & (difference > limit)),
        uncovered,
    )
