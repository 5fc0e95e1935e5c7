"""Convert axes and units of files to the project's: meters, Z up, facing -Y."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidSettingError

ACCLAIM_UNIT = 0.0254 / 0.45
"""Meters per unit of an Acclaim file, and of the BVH files made from them."""
CENTIMETER = 0.01
MILLIMETER = 0.001
ADULT_REACH_M = 2.3
"""The longest path along the bones of an adult, from a hand or the head to a foot, meters.
Measured: 2.0 to 2.6 m in skeletons of nine makers. Unlike the height it does not depend on the
rest pose."""
MIN_BODY_JOINTS = 8
"""Number of joints of a body, from which its size decides on the unit. Chosen by hand: x0.5
fails `test_any_rotation_order_survives_writing_and_reading`, x2
`test_the_unit_is_guessed_from_the_length_of_the_bones`."""


def check_scale(scale: float | None) -> None:
    """Raise InvalidSettingError unless a scale is None or positive and finite."""
    if scale is not None and not 0.0 < scale < float("inf"):
        raise InvalidSettingError(f"scale is {scale:g}; it must be above 0.")


def z_up_from_y_up(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotate vectors, shape (..., 3), by 90 degrees about X: Y up, facing +Z becomes ours."""
    return np.stack([vectors[..., 0], -vectors[..., 2], vectors[..., 1]], axis=-1)


def y_up_from_z_up(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Undo `z_up_from_y_up` of vectors, (..., 3)."""
    return np.stack([vectors[..., 0], vectors[..., 2], -vectors[..., 1]], axis=-1)


def rotations_z_up_from_y_up(rotations: NDArray[np.float64]) -> NDArray[np.float64]:
    """Express quaternions w x y z, shape (..., 4), in the project's axes."""
    return np.concatenate([rotations[..., :1], z_up_from_y_up(rotations[..., 1:])], axis=-1)


def rotations_y_up_from_z_up(rotations: NDArray[np.float64]) -> NDArray[np.float64]:
    """Undo `rotations_z_up_from_y_up` of quaternions, (..., 4)."""
    return np.concatenate([rotations[..., :1], y_up_from_z_up(rotations[..., 1:])], axis=-1)


def longest_bone_path(parents: Sequence[int], offsets: NDArray[np.float64]) -> float:
    """Return the maximum distance between two joints along bones of offsets (n_joints, 3)."""
    below = np.zeros(len(parents))
    longest = 0.0
    for joint in range(len(parents) - 1, 0, -1):
        length = below[joint] + float(np.linalg.norm(offsets[joint]))
        longest = max(longest, below[parents[joint]] + length)
        below[parents[joint]] = max(below[parents[joint]], length)
    return longest


def rotation_to_z_up(axis: str) -> NDArray[np.float64]:
    """Return the quaternion, (4,), that turns what was read with Y up so that `axis` is up."""
    half = np.sqrt(0.5)
    return np.array(
        {
            "Y": (1.0, 0.0, 0.0, 0.0), "-Y": (0.0, 1.0, 0.0, 0.0),
            "Z": (half, -half, 0.0, 0.0), "-Z": (half, half, 0.0, 0.0),
            "X": (half, 0.0, -half, 0.0), "-X": (half, 0.0, half, 0.0),
        }[axis]
    )  # fmt: skip
