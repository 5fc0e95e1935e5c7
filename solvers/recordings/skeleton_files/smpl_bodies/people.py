"""Split the arrays of SMPL bodies by person."""

from collections.abc import Collection, Mapping

import numpy as np

from ....arrays import Array
from .parameters import ALL_ROTATIONS, SIZES
from .rotations import with_rotation_vectors

MAX_PEOPLE = 1000


def split_people(
    arrays: Mapping[str, Array], poses: Mapping[str, Collection[int]]
) -> list[dict[str, Array]]:
    """Return the arrays of each person, without the axis of people.

    Where poses have an axis too many, people are the shorter of the first two axes, and frames
    the longer one. Arrays that do not begin with these two axes are everybody's.

    Parameters
    ----------
    arrays : mapping from name to array
    poses : mapping from name to possible numbers of one pose

    Returns
    -------
    list of dict
        One entry where the file has one person, or its poses have an unknown layout.
    """
    for name, n_numbers in poses.items():
        shape = arrays[name].shape if name in arrays else ()
        is_flat = len(shape) == 3 and shape[2] in n_numbers
        if not is_flat and not (len(shape) == 4 and shape[3] == 3):
            continue
        axis = int(shape[1] < shape[0])
        if not 0 < shape[axis] <= MAX_PEOPLE:
            continue
        return [
            {
                key: np.take(array, person, axis) if array.shape[:2] == shape[:2] else array
                for key, array in arrays.items()
            }
            for person in range(shape[axis])
        ]
    return [dict(arrays)]


def people_of_parameters(arrays: Mapping[str, Array]) -> list[dict[str, Array]]:
    """Return the arrays of each person of a file, (n_frames, ...), rotations as vectors."""
    return split_people(with_rotation_vectors(arrays, ALL_ROTATIONS), SIZES)
