"""Groups of pixels by agreement of rendered and observed depth."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Integers
from .hypothesis import Hypothesis
from .observation import Observation


@dataclass(frozen=True, eq=False)
class PixelGroups:
    """The regions of [WZC12] figure 4.

    Attributes
    ----------
    comparable : int, shape (n,)
        G: visible points of the body (by index) whose pixel shows the actor at a similar
        depth.
    off_actor : int
        B1: visible points whose pixel does not show the actor.
    too_near : int
        B2, type 3: visible points much nearer than the observed depth.
    too_far : int
        B2, type 4: visible points much farther than the observed depth.
    uncovered : int
        B3: pixels of the actor without the body.
    """

    comparable: Integers
    off_actor: Integers
    too_near: Integers
    too_far: Integers
    uncovered: Integers


def group_pixels(hypothesis: Hypothesis, observation: Observation, limit: float) -> PixelGroups:
    """Group pixels; depths that differ by more than `limit`, meters, show different parts."""
    rendered = hypothesis.image.pixels
    observed = observation.flat[rendered]
    on_actor = observed > 0.0
    difference = hypothesis.image.depths - observed
    uncovered = observation.pixels[hypothesis.index_image[observation.pixels] < 0]
    return PixelGroups(
        np.flatnonzero(on_actor & (np.abs(difference) <= limit)),
        np.flatnonzero(~on_actor),
        np.flatnonzero(on_actor & (difference < -limit)),
        np.flatnonzero(on_actor & (difference > limit)),
        uncovered,
    )
