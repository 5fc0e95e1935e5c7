"""Measure how far planted feet slide."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array


@dataclass(frozen=True, eq=False)
class FootSlide:
    """Horizontal motion of one foot in contact.

    Attributes
    ----------
    side : "left" or "right"
    joint : str
        Name of the ankle.
    contact : bool, shape (n_frames,)
    steps : float array, shape (n_frames, 2), meters
        Horizontal displacement since the previous frame; NaN outside contact and where not
        observed.
    frame_rate : float, hertz
    """

    side: str
    joint: str
    contact: NDArray[np.bool_]
    steps: Array
    frame_rate: float

    @property
    def speed(self) -> Array:
        """Horizontal speed, shape (n_frames,), m/s; NaN where `steps` is."""
        return np.asarray(np.linalg.norm(self.steps, axis=1) * self.frame_rate)

    @property
    def mean_speed(self) -> float:
        """Mean horizontal speed in contact, m/s; NaN where the foot is never in contact."""
        observed = self.speed[np.isfinite(self.speed)]
        return float(observed.mean()) if len(observed) else float("nan")

    @property
    def distance(self) -> float:
        """Distance covered in contact over the entire take, meters."""
        return float(np.nansum(self.speed) / self.frame_rate)


def measure_foot_slide(
    side: str,
    joint: str,
    points: Array,
    contact: NDArray[np.bool_],
    frame_rate: float,
    cuts: tuple[int, ...] = (),
) -> FootSlide:
    """Measure the horizontal speed of the slowest part of the foot.

    A rolling foot rotates about its heel, then its ball. The slide is the motion that all its
    points share, so the slowest point counts.

    Parameters
    ----------
    points : shape (n_frames, n_points, 3), meters
        Ankle and toe, or the ankle alone.
    contact : shape (n_frames,)
        A step counts if both of its frames are in contact.
    cuts : tuple of int
        First frames of later segments; no step spans a cut.
    """
    steps = np.full((len(points), 2), np.nan)
    displacements = np.diff(points[..., :2], axis=0)
    lengths = np.nan_to_num(np.linalg.norm(displacements, axis=-1), nan=np.inf)
    slowest = displacements[np.arange(len(displacements)), lengths.argmin(axis=1)]
    steps[1:] = np.where((contact[1:] & contact[:-1])[:, None], slowest, np.nan)
    steps[list(cuts)] = np.nan
    return FootSlide(side, joint, contact, steps, frame_rate)
