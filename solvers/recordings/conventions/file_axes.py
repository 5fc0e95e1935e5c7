"""Turn a recording whose file has other axes than was estimated."""

from dataclasses import replace
from typing import TypeVar, cast

import numpy as np

from ...arrays import Array
from ...errors import InvalidSettingError
from ...motion import AxisName, FileConventions, JointRecording, Motion, Tracks
from ...rotations import (
    inverse,
    matrix_from_quaternion,
    multiply,
    quaternion_from_matrix,
    rotate,
)

Recording = TypeVar("Recording", bound=Motion | Tracks | JointRecording)

AXIS_NAMES: tuple[AxisName, ...] = ("X", "Y", "Z", "-X", "-Y", "-Z")
FORWARD: dict[AxisName, AxisName] = {
    "Y": "Z", "-Y": "-Z", "Z": "-Y", "-Z": "Y", "X": "Z", "-X": "Z",
}  # fmt: skip
"""Where actors face in a file, by the axis that is up, unless it is said (`rotate_to_z_up`)."""
MIRRORED = np.array([1.0, 1.0, -1.0, -1.0])
"""Factor of a quaternion whose rotation is mirrored: X is negated."""


def file_conventions(
    up: AxisName, forward: AxisName | None = None, unit: float = 1.0
) -> FileConventions:
    """Return conventions that are known, with the usual forward axis unless it is given."""
    return FileConventions(up, forward or FORWARD[up], unit)


def with_axes(
    conventions: FileConventions, up: AxisName | None, forward: AxisName | None
) -> FileConventions:
    """Return conventions with the axes that the user chose; None keeps what was estimated.

    Where only another up axis is given, the usual forward axis belongs to it.

    Raises
    ------
    InvalidSettingError
        Both are the same axis.
    """
    if up in {None, conventions.up}:
        new_up, new_forward = conventions.up, forward or conventions.forward
    else:
        new_up = up or conventions.up
        new_forward = forward or FORWARD[new_up]
    if new_up[-1] == new_forward[-1]:
        raise InvalidSettingError(
            f"Up is {new_up} and Forward is {new_forward}; they must be different axes."
        )
    keeps_rest = conventions.rest_up not in {None, conventions.up} and up is not None
    return replace(
        conventions,
        up=new_up,
        forward=new_forward,
        rest_up=conventions.rest_up if keeps_rest else None,
        confidence=1.0 if up is not None else conventions.confidence,
        stated_up=None if up is not None else conventions.stated_up,
    )


def rotation_between(before: FileConventions, after: FileConventions) -> Array:
    """Return the quaternion, (4,), from what `before` reads to what `after` would read."""
    rotation = np.asarray(quaternion_from_matrix(_matrix(after) @ _matrix(before).T))
    return rotation * MIRRORED if before.is_mirrored else rotation


def rotated_conventions(before: FileConventions, rotation: Array) -> FileConventions:
    """Return the axes of the file that are up and forward after a rotation by a quaternion.

    Parameters
    ----------
    before : conventions by which the recording was read
    rotation : quaternion, (4,), to axes of the project, by multiples of 90 degrees
    """
    matrix = matrix_from_quaternion(rotation) @ _matrix(before)
    return replace(before, up=_name_axis(matrix[2]), forward=_name_axis(-matrix[1]))


def reinterpreted(
    recording: Recording, up: AxisName | None, forward: AxisName | None
) -> Recording:
    """Return a recording as it is if its file has these axes; None keeps what was estimated.

    The rest pose turns along, unless another axis of its own was estimated to be up in it.
    """
    before = conventions_of(recording)
    after = with_axes(before, up, forward)
    return with_conventions(rotate_recording(recording, before, after), after)


def rotate_recording(
    recording: Recording, before: FileConventions, after: FileConventions
) -> Recording:
    """Return a recording that was read by some conventions in the axes of others."""
    rotation = rotation_between(before, after)
    if abs(rotation[0]) > 1.0 - 1e-12:
        return recording
    if isinstance(recording, JointRecording):
        joints = recording.with_tracks(rotate_recording(recording.tracks, before, after))
        return cast(Recording, joints)
    if isinstance(recording, Tracks):
        points = recording.with_positions(rotate(rotation, recording.positions))
        return cast(Recording, points)
    keeps_rest = after.rest_up is not None and before.up != after.up
    rest_rotation = np.array([1.0, 0.0, 0.0, 0.0]) if keeps_rest else rotation
    return cast(Recording, rotate_motion(recording, rotation, rest_rotation))


def rotate_motion(motion: Motion, rotation: Array, rest_rotation: Array) -> Motion:
    """Rotate the motion of a body by one quaternion, (4,), and its rest pose by another."""
    skeleton = replace(motion.skeleton, offsets=rotate(rest_rotation, motion.skeleton.offsets))
    rotations = multiply(multiply(rest_rotation, motion.rotations), inverse(rest_rotation))
    rotations[:, 0] = multiply(
        multiply(rotation, motion.rotations[:, 0]), inverse(rest_rotation)
    )
    return replace(
        motion,
        skeleton=skeleton,
        rotations=rotations,
        root_positions=rotate(rotation, motion.root_positions),
    )


def conventions_of(recording: Motion | Tracks | JointRecording) -> FileConventions:
    """Return how the file was interpreted; Z up and meters where that was not noted."""
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    return tracks.conventions or FileConventions()


def with_conventions(recording: Recording, conventions: FileConventions) -> Recording:
    """Return a recording with a note of how its file was interpreted."""
    if isinstance(recording, JointRecording):
        noted = recording.with_tracks(replace(recording.tracks, conventions=conventions))
        return cast(Recording, noted)
    return replace(recording, conventions=conventions)


def _matrix(conventions: FileConventions) -> Array:
    """Return the rotation from the axes of the file to ours: -Y is forward and Z is up."""
    up, forward = _direction(conventions.up), _direction(conventions.forward)
    return np.asarray(np.stack([np.cross(up, forward), -forward, up]))


def _name_axis(direction: Array) -> AxisName:
    """Return the axis nearest to a direction in the axes of a file."""
    index = int(np.argmax(np.abs(direction)))
    return AXIS_NAMES[index + 3 * bool(direction[index] < 0.0)]


def _direction(axis: AxisName) -> Array:
    return np.asarray(np.eye(3)["XYZ".index(axis[-1])] * (-1.0 if axis[0] == "-" else 1.0))
