"""A recording as plain columns of numbers for a linear model."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from .travel_path import TravelPath

CENTIMETERS = 100.0
"""Lengths are in centimeters and angles in degrees: for limbs these are of similar size.
Centimeters per meter, by definition."""


@dataclass(frozen=True, eq=False)
class Channels:
    """A recording relative to the travel path of its body and to mean rotations or positions.

    Attributes
    ----------
    keys : tuple of str, length n_parts
        Name of each part of three channels: a joint (its humanoid role, or its name), a point,
        or the root position. Equal keys mean the same in all recordings.
    values : shape (n_frames, n_parts, 3), degrees or centimeters
        NaN where not observed.
    joints : shape (n_parts,)
        Index of the joint or point of each part.
    references : mapping of key to array
        Origin of each part's values, as `encode_motion` or `encode_tracks` needs it.
    path : TravelPath
        Position and heading of the body.
    moving_references : shape (n_frames, n_parts - 1, 4), optional
        Rotations of the joints' references over time, of a motion.
    parents : shape (n_parts,), optional
        Index of the part of each joint's parent, of a motion; -1 where there is none.
    """

    keys: tuple[str, ...]
    values: Array
    joints: NDArray[np.intp]
    references: Mapping[str, Array]
    path: TravelPath
    moving_references: Array | None = None
    parents: NDArray[np.intp] | None = None

    @property
    def flat(self) -> Array:
        """Values as columns, shape (n_frames, 3 n_parts)."""
        return self.values.reshape(len(self.values), -1)

    @property
    def n_rotations(self) -> int:
        """Number of columns, the first ones, that are rotations of joints."""
        return 0 if self.moving_references is None else self.flat.shape[1] - 3
