"""Recordings as plain columns of numbers that a linear model can speak about, and back."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion, Tracks
from .channels_path import Path

Array = NDArray[np.float64]

CENTIMETRES = 100.0
"""Lengths are in centimetres and angles in degrees: for limbs a few of either are alike."""


@dataclass(frozen=True, eq=False)
class Channels:
    """A recording relative to where its body is and to mean rotations or positions.

    Attributes
    ----------
    recording : Motion or Tracks
        What was encoded; decoding starts from it.
    keys : tuple of str, length n_parts
        What each part of three channels tells about: a joint, a point or the root's place.
        Equal keys mean the same thing in different recordings.
    values : shape (n_frames, n_parts, 3), degrees or centimetres
        NaN where not observed.
    joints : shape (n_parts,)
        Index of the joint or point that each part belongs to.
    references : mapping of key to array
        Mean rotation, shape (4,), or position, shape (3,), that a part is told relative to.
    path : Path
        Where the body is.
    """

    recording: Motion | Tracks
    keys: tuple[str, ...]
    values: Array
    joints: NDArray[np.intp]
    references: Mapping[str, Array]
    path: Path

    @property
    def flat(self) -> Array:
        """The values as columns, shape (n_frames, 3 n_parts)."""
        return self.values.reshape(len(self.values), -1)
