"""How far planted feet slide."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FootSlide:
    """How one foot moves over the ground while it should stand.

    Attributes
    ----------
    side : "left" or "right"
    joint : str
        The ankle's name.
    contact : bool, shape (n_frames,)
    steps : float array, shape (n_frames, 2), metres
        Horizontal way from the frame before; NaN outside contact and where not observed.
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
        known = self.speed[np.isfinite(self.speed)]
        return float(known.mean()) if len(known) else float("nan")

    @property
    def distance(self) -> float:
        """Way covered in contact over the whole take, metres."""
        return float(np.nansum(self.speed) / self.frame_rate)


def measure_foot_slide(
    side: str,
    joint: str,
    points: Array,
    contact: NDArray[np.bool_],
    frame_rate: float,
    cuts: tuple[int, ...] = (),
) -> FootSlide:
    """Measure the horizontal speed of the part of the foot that stands still most.

    A foot that rolls turns about its heel, then its ball: what moves over the ground is only
    what all its points share, so the slowest of them counts.

    Parameters
    ----------
    points : shape (n_frames, n_points, 3), metres
        Ankle and toe, or the ankle alone.
    contact : shape (n_frames,)
        A step between two frames counts where both are in contact.
    cuts : tuple of int
        Frames that have nothing to do with those before: no step leads to them.
    """
    steps = np.full((len(points), 2), np.nan)
    displacements = np.diff(points[..., :2], axis=0)
    lengths = np.nan_to_num(np.linalg.norm(displacements, axis=-1), nan=np.inf)
    slowest = displacements[np.arange(len(displacements)), lengths.argmin(axis=1)]
    steps[1:] = np.where((contact[1:] & contact[:-1])[:, None], slowest, np.nan)
    steps[list(cuts)] = np.nan
    return FootSlide(side, joint, contact, steps, frame_rate)
