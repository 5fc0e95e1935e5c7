"""Recordings as plain columns of numbers that a linear model can speak about."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .travel_path import TravelPath

Array = NDArray[np.float64]

CENTIMETERS = 100.0
"""Lengths are in centimetres and angles in degrees: for limbs a few of either are alike."""


@dataclass(frozen=True, eq=False)
class Channels:
    """A recording relative to where its body is and to mean rotations or positions.

    Attributes
    ----------
    keys : tuple of str, length n_parts
        What each part of three channels tells about: a joint (by its humanoid role, or else its
        name), a point, or the root's place. Equal keys mean the same in all recordings.
    values : shape (n_frames, n_parts, 3), degrees or centimetres
        NaN where not observed.
    joints : shape (n_parts,)
        Index of the joint or point that each part belongs to.
    references : mapping of key to array
        What each part is told relative to; as many numbers as `channels_motion` or
        `channels_tracks` need.
    path : Path
        Where the body is.
    """

    keys: tuple[str, ...]
    values: Array
    joints: NDArray[np.intp]
    references: Mapping[str, Array]
    path: TravelPath

    @property
    def flat(self) -> Array:
        """The values as columns, shape (n_frames, 3 n_parts)."""
        return self.values.reshape(len(self.values), -1)
