"""Forward kinematics of the body model, with exact derivatives."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...rotations import cross, skew_matrices
from .coordinates import N_COORDINATES, N_ROOT, ROTATION_AXES
from .model import BodyModel
from .tables import END_SEGMENTS, PARENTS, SEGMENTS

N_SEGMENTS = len(SEGMENTS)
_PARENT = np.array(PARENTS)
_YAW_ROLL_PITCH = np.eye(3)[[1, 2, 0]]
"""Axes of the rotations of the root, in the order of its coordinates."""
_SMALL_ANGLE = 1e-4
"""Radians below which a series replaces the quotient. It guards a division."""


def _axis_tables() -> tuple[NDArray[np.intp], Array, Array, Array]:
    """List all pairs of a segment and a coordinate that rotates it about its own joint.

    Returns the segment of each axis (n_axes,), its rotation vector (n_axes, 3), the segments
    it moves (n_segments, n_axes), and its coordinate as a one-hot row (n_axes, 36).
    """
    segments, coordinates = np.nonzero(np.any(ROTATION_AXES != 0.0, axis=1))
    moves = np.zeros((N_SEGMENTS, len(segments)))
    for segment in range(N_SEGMENTS):
        ancestor = segment
        while ancestor >= 0:
            moves[segment, segments == ancestor] = 1.0
            ancestor = PARENTS[ancestor]
    return (
        segments,
        ROTATION_AXES[segments, :, coordinates],
        moves,
        np.eye(N_COORDINATES)[coordinates],
    )


def _levels() -> list[tuple[NDArray[np.intp], NDArray[np.intp]]]:
    """List segments equally far from the root, and their parents; nearest first, no root."""
    depths = [0]
    for parent in PARENTS[1:]:
        depths.append(depths[parent] + 1)
    levels = (np.flatnonzero(np.array(depths) == depth) for depth in range(1, max(depths) + 1))
    return [(segments, _PARENT[segments]) for segments in levels]


_LEVELS = _levels()
_AXIS_SEGMENT, _AXES, _MOVES, _AXIS_COORDINATE = _axis_tables()


def segment_frames(body: BodyModel, poses: Array) -> Array:
    """Return the transforms of the segments of a body.

    Parameters
    ----------
    body : BodyModel
    poses : shape (..., 36)
        Coordinates in the order of `COORDINATES`; meters and radians.

    Returns
    -------
    array, shape (..., 17, 4, 4)
        camera_from_segment of each of the `SEGMENTS`; its translation is the joint.
    """
    poses = np.asarray(poses, dtype=np.float64)
    frames = np.zeros((*poses.shape[:-1], N_SEGMENTS, 4, 4))
    frames[..., :3, :3] = matrix_from_rotation_vector(
        np.einsum("sik,...k->...si", ROTATION_AXES, poses)
    )
    frames[..., :3, 3] = body.offsets[:N_SEGMENTS]
    frames[..., 3, 3] = 1.0
    frames[..., 0, :3, :3], frames[..., 0, :3, 3] = _root_rotation(poses), poses[..., :3]
    for segments, parents in _LEVELS:
        frames[..., segments, :, :] = frames[..., parents, :, :] @ frames[..., segments, :, :]
    return frames


def joint_positions(body: BodyModel, frames: Array) -> Array:
    """Return the `JOINTS` (..., 21, 3), meters, from segment transforms (..., 17, 4, 4)."""
    carriers = frames[..., list(END_SEGMENTS), :, :]
    ends = carriers[..., :3, 3] + np.einsum(
        "...sij,sj->...si", carriers[..., :3, :3], body.offsets[N_SEGMENTS:]
    )
    return np.concatenate([frames[..., :3, 3], ends], axis=-2)


def segment_twists(pose: Array, frames: Array) -> Array:
    """Return the exact derivative of `segment_frames` as spatial twists.

    Parameters
    ----------
    pose : shape (36,)
    frames : shape (17, 4, 4)
        The segment transforms in this pose.

    Returns
    -------
    array, shape (17, 6, 36)
        Spatial twists. A small change e of a coordinate rotates a segment by e times the first
        three components about an axis through the camera, and translates it by e times the
        last three. A point p on it moves by e (twist[:3] x p + twist[3:]). Zero if a coordinate
        does not move a segment.
    """
    rotations = frames[:, :3, :3]
    vectors = (ROTATION_AXES @ pose)[_AXIS_SEGMENT]
    local = np.einsum("nij,nj->ni", _left_jacobians(vectors), _AXES)
    axes = np.einsum("nij,nj->ni", rotations[_PARENT[_AXIS_SEGMENT]], local)
    centers = frames[_AXIS_SEGMENT, :3, 3]
    screws = np.concatenate([axes, cross(centers, axes)], axis=1)
    segment_screws = _MOVES[:, np.newaxis, :] * screws.T
    twists: Array = segment_screws @ _AXIS_COORDINATE
    twists[:, :, :N_ROOT] = _root_twists(pose)
    return twists


def matrix_from_rotation_vector(vectors: Array) -> Array:
    """Return the rotation matrices (..., 3, 3) of rotation vectors (..., 3), radians."""
    angles, crosses = _angles_and_crosses(vectors)
    first, second = np.sinc(angles / np.pi), 0.5 * np.sinc(0.5 * angles / np.pi) ** 2
    return _series(first, second, crosses)


def _left_jacobians(vectors: Array) -> Array:
    """Return the left Jacobians J of rotation vectors: exp(w + dw) = exp(J dw) exp(w)."""
    angles, crosses = _angles_and_crosses(vectors)
    squares = np.maximum(angles, _SMALL_ANGLE) ** 2
    third = np.where(
        angles < _SMALL_ANGLE, 1.0 / 6.0, (1.0 - np.sinc(angles / np.pi)) / squares
    )
    return _series(0.5 * np.sinc(0.5 * angles / np.pi) ** 2, third, crosses)


def _angles_and_crosses(vectors: Array) -> tuple[Array, Array]:
    angles = np.sqrt(np.einsum("...i,...i->...", vectors, vectors))
    return angles, skew_matrices(vectors)


def _series(first: Array, second: Array, crosses: Array) -> Array:
    rotation: Array = np.eye(3) + first[..., np.newaxis, np.newaxis] * crosses
    rotation += second[..., np.newaxis, np.newaxis] * (crosses @ crosses)
    return rotation


def _root_rotation(poses: Array) -> Array:
    about_y, about_z, about_x = np.moveaxis(_root_rotations(poses), -3, 0)
    rotation: Array = about_y @ about_z @ about_x
    return rotation


def _root_rotations(poses: Array) -> Array:
    """Return the rotations of yaw, roll and pitch, shape (..., 3, 3, 3)."""
    return matrix_from_rotation_vector(poses[..., 3:N_ROOT, np.newaxis] * _YAW_ROLL_PITCH)


def _root_twists(pose: Array) -> Array:
    """Return the twists of the root coordinates, shape (6, 6)."""
    twists = np.zeros((6, N_ROOT))
    twists[3:, :3] = np.eye(3)
    about_y, about_z, _ = _root_rotations(pose)
    axes = np.array([[0.0, 1.0, 0.0], about_y[:, 2], (about_y @ about_z)[:, 0]])
    twists[:3, 3:], twists[3:, 3:] = axes.T, cross(pose[:3], axes).T
    return twists
