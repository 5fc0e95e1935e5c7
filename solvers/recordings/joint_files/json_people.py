"""Find the people in a frame of JSON, and their joints, however these are nested."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from ...arrays import Array
from ..point_bodies import has_layout, without_undetected
from .body_json import name_of_body


def either_case(*keys: str) -> tuple[str, ...]:
    """Return keys as they are, and as programs in C# write them: with a capital."""
    return tuple(
        spelled for key in keys for spelled in dict.fromkeys((key, key[:1].upper() + key[1:]))
    )


POINT_KEYS = either_case(
    "keypoints3d", "keypoints_3d", "joints3d", "joints_3d", "joints3D", "pose_keypoints_3d",
    "pose3d", "pose_3d", "poses_3d", "positions", "joints", "keypoints", "bones", "xyz",
)  # fmt: skip
"""Members with the joints of a person."""
PEOPLE_KEYS = either_case("instances", "people", "persons", "bodies", "skeletons", "annots")
"""Members with the people of a frame."""
IDENTITY_KEYS = either_case("id", "track_id", "person_id", "body_id", "personID",
                            "tracking_id", "trackingId")  # fmt: skip
NAME_KEYS = either_case("name", "joint", "joint_name", "jointName", "bone", "bone_name", "type",
                        "jointType", "id")  # fmt: skip
"""Members with the name of a joint, where joints are objects in a list."""
POSITION_KEYS = either_case("position", "pos", "translation", "location", "transform", "matrix")
"""Members with the place of a joint, or with the matrix of its pose."""
NUMBER_KEYS = either_case("frame", "frame_id", "frame_number", "frame_index", "frame_idx",
                          "frameId", "frameNumber", "frameIndex")  # fmt: skip
"""Members with the number of a frame."""
RATE_KEYS = (*either_case("fps", "frame_rate", "framerate", "frameRate"), "FPS")
TIME_KEYS = dict.fromkeys(either_case("timestamp", "time")) | dict.fromkeys(
    either_case("timestamp_ms", "time_ms"), 0.001
)
"""Seconds per unit of the time of a frame; None where the key does not state it."""
NUMBERS_KEYS = either_case("frame_ids", "frameIds", "frame_numbers", "frame_indices")
"""Members with the numbers of all frames of a person."""
TIMES_KEYS = {key: key for key in TIME_KEYS} | {
    f"{key.removesuffix('_ms')}s{'_ms' * key.endswith('_ms')}": key for key in TIME_KEYS
}
"""Members with the times of all frames of a person, and those that state it of a frame."""
START_KEYS = either_case("start_frame", "startFrame")
"""Members with the number of the first frame of a person."""
MAX_NUMBER = 1e300
"""Maximum number or time of a frame, or rate in hertz. It guards the conversion of whole
numbers, which JSON does not limit."""
MIN_JOINTS = 8
"""Number of joints of a person. It guards JSON of something else."""

MAX_ROUNDING = 1e-3
"""Difference between the length of a unit quaternion and 1, as a ratio. It bounds the rounding
to three decimals, by which quaternions differ from positions."""


class JsonPerson(NamedTuple):
    """A person of a frame, and the joints."""

    identity: str
    names: tuple[str, ...]
    """Empty if the joints have none."""
    positions: Array
    """Shape (n_joints, 3)."""


def people_of_frame(frame: Any) -> Iterator[JsonPerson]:
    """Yield the people of a frame."""
    if isinstance(frame, list):
        points = _points(frame)
        if points is not None:
            yield JsonPerson("0", (), points)
            return
        listed = frame
    elif isinstance(frame, dict):
        listed = next(
            (found for found in _members(frame, PEOPLE_KEYS) if isinstance(found, list)),
            [frame],
        )
    else:
        return
    for count, body in enumerate(listed):
        if isinstance(body, Mapping):
            yield from _person(body, count)
        elif isinstance(body, list) and (points := _points(body)) is not None:
            yield JsonPerson(str(count), (), points)


def _person(body: Mapping[str, Any], count: int) -> Iterator[JsonPerson]:
    joints: Any = next(filter(None, _members(body, POINT_KEYS)), None)
    identity = name_of_body(body, IDENTITY_KEYS, count)
    names: tuple[str, ...] = ()
    if isinstance(joints, Mapping):
        names, joints = tuple(map(str, joints)), list(joints.values())
    elif isinstance(joints, list) and joints and all(isinstance(k, Mapping) for k in joints):
        names = _names_of(joints)
    values = [position_of(joint) for joint in joints] if names else joints
    points = _points(values) if isinstance(values, list) else None
    if points is not None:
        yield JsonPerson(identity, names, points)
    elif not joints:
        yield from _keyed_people(body, identity)


def _keyed_people(body: Mapping[str, Any], identity: str) -> Iterator[JsonPerson]:
    """Yield who has a place for each joint, by its name, or who is keyed by name or number."""
    nested = {key: value for key, value in body.items() if isinstance(value, Mapping)}
    for name, joints in {identity: body, **nested}.items():
        if any(map(joints.get, POINT_KEYS)):
            yield from (each._replace(identity=name) for each in _person(joints, 0))
            continue
        positions = {str(key): position_of(value) for key, value in joints.items() if value}
        for width in (3, 4):
            found = {
                key: position
                for key, position in positions.items()
                if _width(position) == width
            }
            points = _points([*found.values()]) if len(found) >= MIN_JOINTS else None
            if points is not None:
                yield JsonPerson(name, tuple(found), points)
                break


def _members(values: Mapping[str, Any], keys: tuple[str, ...]) -> Iterator[Any]:
    return (values[key] for key in keys if key in values)


def as_frame(value: Any) -> dict[str, Any]:
    """Return a frame as an object: a list is one of points or of people."""
    if isinstance(value, Mapping):
        return dict(value)
    is_body = isinstance(value, list) and _points(value) is not None
    return {PEOPLE_KEYS[0]: [value] if is_body else value}


def is_number(value: Any) -> bool:
    """Return whether a value is a finite number that fits in a float."""
    is_real = isinstance(value, int | float) and not isinstance(value, bool)
    return is_real and abs(value) < MAX_NUMBER


def listed_numbers(value: Mapping[str, Any], keys: Iterable[str], n_frames: int) -> list[float]:
    """Return the numbers in a member, if there is another one for each frame."""
    listed = next((value[key] for key in keys if key in value), None)
    if not isinstance(listed, list) or not all(map(is_number, listed)):
        return []
    numbers = [float(number) for number in listed]
    return numbers if len(numbers) == len({*numbers}) == n_frames else []


def have_identities(frames: list[Any]) -> bool:
    """Return whether all of these are people with identities of their own."""
    stated = [
        next((str(each[key]) for key in IDENTITY_KEYS if key in each), None)
        for each in frames
        if isinstance(each, Mapping)
    ]
    return len({*stated}) == len(frames) and None not in stated


def is_position(value: Any) -> bool:
    """Return whether a value is x, y and z, perhaps with a fourth number, or null.

    An object with joints or people is a frame, which may have the place of its camera, too.
    """
    if isinstance(value, Mapping) and not value.keys().isdisjoint((*POINT_KEYS, *PEOPLE_KEYS)):
        return False
    return value is None or _width(position_of(value)) in {3, 4}


def _width(position: Any) -> int:
    """Return how many numbers a list has, nulls included; 0 for other values."""
    is_row = isinstance(position, list) and any(map(_is_number, position))
    is_complete = is_row and all(each is None or _is_number(each) for each in position)
    return len(position) if is_complete else 0


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _names_of(joints: list[Mapping[str, Any]]) -> tuple[str, ...]:
    """Return the names of joints that are objects, by the first member that differs in all."""
    for key in NAME_KEYS:
        names = tuple(str(joint.get(key)) for joint in joints)
        if len({*names}) == len(names):
            return names
    return ()


def position_of(joint: Any) -> Any:
    """Return x, y, z of an object or a matrix of 4 x 4; other values as they are."""
    if joint is None:
        return [None] * 3
    if isinstance(joint, Mapping):
        inner = next(_members(joint, POSITION_KEYS), joint)
        if isinstance(inner, Mapping):
            lower = {str(key).lower(): value for key, value in inner.items()}
            return [lower.get(axis, lower.get(f"camera{axis}")) for axis in "xyz"]
        joint = inner
    if isinstance(joint, list) and len(joint) in {4, 16}:
        return _translation(joint)
    return joint


def _translation(values: list[Any]) -> Any:
    """Return the translation of a matrix, by rows or columns; other values as they are."""
    try:
        matrix = np.array(values, dtype=np.float64).reshape(4, 4)
    except (ValueError, TypeError, OverflowError):
        return values
    if np.array_equal(matrix[3], (0.0, 0.0, 0.0, 1.0)):
        return matrix[:3, 3].tolist()
    if np.array_equal(matrix[:, 3], (0.0, 0.0, 0.0, 1.0)):
        return matrix[3, :3].tolist()
    return values


def _points(values: list[Any]) -> Array | None:
    """Return nested or flat numbers as points, shape (n_points, 3); None for other values."""
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
    return None if is_rotation else without_undetected(array)
