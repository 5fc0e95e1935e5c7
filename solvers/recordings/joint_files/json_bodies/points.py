"""Read the points of a body from JSON, however each of them is written."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from ....arrays import Array
from ....motion.skeletons import BODY_POINTS
from ...containers import NUMBER
from ...point_bodies import N_POINTS, has_layout, without_undetected


def either_case(*keys: str) -> tuple[str, ...]:
    """Return keys as they are, and as programs in C# write them: with a capital."""
    return tuple(
        spelled for key in keys for spelled in dict.fromkeys((key, key[:1].upper() + key[1:]))
    )


LANDMARK_KEYS = (
    "worldLandmarks", "pose_world_landmarks", "poseWorldLandmarks", "world_landmarks",
    "keypoints3D", "landmarks", "pose_landmarks", "poseLandmarks", "landmark",
)  # fmt: skip
"""Members with MediaPipe's landmarks, those of the world before those of the picture."""
NAME_KEYS = either_case("name", "joint", "joint_name", "jointName", "bone", "bone_name", "type",
                        "jointType", "id")  # fmt: skip
"""Members with the name of a joint, where joints are objects in a list."""
POSITION_KEYS = either_case("position3D", "position3d", "position_3d",
                            "worldPosition", "world_position", "globalPosition",
                            "global_position", "worldTransform", "modelTransform",
                            "model_transform", "position", "pos", "translation", "location",
                            "coordinates", "coords", "p", "transform", "matrix")  # fmt: skip
"""Members with the position of a joint, those of the room first, or with its matrix."""
INNER_KEYS = ("xyz", "v", "value")
"""Members of a position with its coordinates, as in the structures of the Azure Kinect."""
CONFIDENCE_KEYS = ("visibility", "presence", "score", "confidence")
MAX_CONFIDENCE = 100.0
"""Confidence in percent, by definition; larger numbers are something else."""
MIN_JOINTS = 8
"""Number of joints of a person. It guards JSON of something else."""
LAST_ROW = (0.0, 0.0, 0.0, 1.0)
"""Of a transform, by definition."""
MAX_ROUNDING = 1e-3
"""Difference between the length of a unit quaternion and 1, as a ratio. It bounds the rounding
to three decimals, by which quaternions differ from positions."""


class Points(NamedTuple):
    """The joints of a person in a frame."""

    positions: Array
    """Shape (n_joints, 3)."""
    confidence: Array
    """Shape (n_joints,), NaN where it is not stated."""
    names: tuple[str, ...]
    """Empty if the joints have none."""


def points_of(joints: Any, key: str = "") -> Points | None:
    """Return what a member holds as the points of a body; None for other values.

    Parameters
    ----------
    joints : list of points, of numbers, or of objects; or an object with a point for each name
        or number
    key : of the member; MediaPipe's landmarks get their names by it
    """
    names: tuple[str, ...] = ()
    if isinstance(joints, Mapping):
        names, joints = _names_in_keys(joints), list(joints.values())
    if not isinstance(joints, list):
        return None
    objects = [joint for joint in joints if isinstance(joint, Mapping)]
    if len(objects) == len(joints):
        names = names or _names_of(objects)
    array = _array(_positions(joints) if names or objects else joints)
    if array is None:
        return None
    confidence = array[:, 3] if array.shape[1] == 4 else np.full(len(array), np.nan)
    if objects:
        confidence = np.array([_confidence_of(joint) for joint in joints])
    if array.shape[1] == 4:
        array = without_undetected(array)
    has_visibility = any("visibility" in joint for joint in objects)
    if not names and len(array) == N_POINTS and (key in LANDMARK_KEYS or has_visibility):
        names = BODY_POINTS
    return Points(array, confidence, names)


def _names_in_keys(joints: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the keys of joints, which are no names where they are 0, 1, 2 and so on."""
    names = tuple(map(str, joints))
    return () if names == tuple(map(str, range(len(names)))) else names


def _positions(joints: list[Any]) -> list[Any]:
    """Return the positions of joints: null for objects without any, if others have one."""
    positions = [position_of(joint) for joint in joints]
    if all(isinstance(position, Mapping) or joint is None
           for position, joint in zip(positions, joints, strict=True)):  # fmt: skip
        return []
    return [[None] * 3 if isinstance(each, Mapping) else each for each in positions]


def members(values: Mapping[str, Any], keys: tuple[str, ...]) -> Iterator[Any]:
    """Yield those of the members that there are, in the order of the keys."""
    return (values[key] for key in keys if key in values)


def position_of(joint: Any) -> Any:
    """Return x, y, z of an object with them or a matrix of 4 x 4; other values as they are."""
    if joint is None:
        return [None] * 3
    if isinstance(joint, Mapping):
        inner = _nested(joint, POSITION_KEYS)
        if isinstance(inner, Mapping):
            inner = _nested(inner, INNER_KEYS)
        if isinstance(inner, Mapping):
            lower = {str(key).lower(): value for key, value in inner.items()}
            axes = [f"{each}{axis}" for each in ("", "p", "pos", "camera") for axis in "xyz"]
            found = [lower[axis] for axis in axes if axis in lower]
            return found[:3] if len(found) >= 3 else inner
        joint = inner
    matrix = _matrix(joint)
    return joint if matrix is None else matrix[:3, 3].tolist()


def transform_of(value: Any) -> Array | None:
    """Return a matrix of 4 x 4, or that of a position; None for other values."""
    inner = _nested(value, POSITION_KEYS) if isinstance(value, Mapping) else value
    matrix = _matrix(inner)
    position = position_of(value)
    if matrix is None and width_of(position) == 3:
        matrix = np.eye(4)
        matrix[:3, 3] = [np.nan if each is None else each for each in position]
    return matrix


def _nested(values: Mapping[str, Any], keys: tuple[str, ...]) -> Any:
    """Return the first member that may hold coordinates, otherwise the object itself.

    A number of the same name is something else, such as `v` for visibility.
    """
    found = members(values, keys)
    return next((each for each in found if isinstance(each, list | Mapping | None)), values)


def width_of(position: Any) -> int:
    """Return how many numbers a list has, nulls included; 0 for other values."""
    is_row = isinstance(position, list) and any(map(_is_number, position))
    is_complete = is_row and all(each is None or _is_number(each) for each in position)
    return len(position) if is_complete else 0


def _is_number(value: Any) -> bool:
    """Return whether a value is a number, or the text of one."""
    if isinstance(value, str):
        return NUMBER.fullmatch(value.encode()) is not None
    return isinstance(value, int | float) and not isinstance(value, bool)


def _confidence_of(joint: Any) -> float:
    if not isinstance(joint, Mapping):
        return np.nan
    value = next(members(joint, CONFIDENCE_KEYS), np.nan)
    try:
        confidence = float(value) if _is_number(value) else np.nan
    except (ValueError, OverflowError):  # a decimal comma, or a number without bounds
        return np.nan
    return confidence if abs(confidence) <= MAX_CONFIDENCE else np.nan


def _names_of(joints: list[Mapping[str, Any]]) -> tuple[str, ...]:
    """Return the names of joints that are objects, by the first member that differs in all."""
    for key in NAME_KEYS:
        names = tuple(str(joint.get(key)) for joint in joints)
        if len({*names}) == len(names):
            return names
    return ()


def _matrix(values: Any) -> Array | None:
    """Return a transform of 4 x 4 numbers, by rows or columns; None for other values."""
    if not isinstance(values, list) or len(values) not in {4, 16}:
        return None
    try:
        matrix = np.array(values, dtype=np.float64).reshape(4, 4)
    except (ValueError, TypeError, OverflowError):
        return None
    by_orientation = (matrix, matrix.T)
    return next((each for each in by_orientation if np.array_equal(each[3], LAST_ROW)), None)


def _array(values: list[Any]) -> Array | None:
    """Return nested or flat numbers as an array, shape (n_points, 3 or 4); else None.

    A null among points is one that was not observed.
    """
    width = next((len(each) for each in values if isinstance(each, list)), 0)
    if width:
        values = [[None] * width if each is None else each for each in values]
    try:
        array = np.array(values, dtype=np.float64)
    except (ValueError, TypeError, OverflowError):
        return None
    if array.ndim == 1 and len(array) >= 3 * MIN_JOINTS:
        widths = [width for width in (3, 4) if len(array) % width == 0]
        known = [width for width in widths if has_layout(len(array) // width)]
        array = array.reshape(-1, (known or widths)[0]) if widths else array
    if array.ndim != 2 or array.shape[1] not in {3, 4} or len(array) < MIN_JOINTS:
        return None
    if array.shape[1] == 3:
        return array
    is_rotation = np.abs(np.linalg.norm(array, axis=1) - 1.0).max() < MAX_ROUNDING
    return None if is_rotation else array
