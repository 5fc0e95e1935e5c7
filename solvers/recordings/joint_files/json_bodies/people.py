"""Find the people in a frame of JSON, and their joints, however these are nested."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from ...point_bodies import is_quantity, read_time, time_name
from .bodies import name_of_body
from .points import (
    LANDMARK_KEYS,
    MIN_JOINTS,
    Points,
    either_case,
    members,
    points_of,
    position_of,
    width_of,
)

POINT_KEYS = (*LANDMARK_KEYS, *either_case(
    "keypoints3d", "keypoints_3d", "joints3d", "joints_3d", "joints3D",
    "pose_keypoints_3d", "pose3d", "pose_3d", "poses_3d", "positions", "joints", "keypoints",
    "bones", "points", "xyz",
))  # fmt: skip
"""Members with the joints of a person."""
PEOPLE_KEYS = either_case("instances", "people", "persons", "bodies", "skeletons",
                          "annots", "actors", "characters")  # fmt: skip
"""Members with the people of a frame."""
IDENTITY_KEYS = either_case("id", "track_id", "person_id", "body_id", "personID",
                            "tracking_id", "trackingId")  # fmt: skip
NAMES_OF_PEOPLE = (*IDENTITY_KEYS, *either_case("name"))
"""Members with the identity of people in a list."""
NUMBER_KEYS = either_case("frame", "frame_id", "frame_number", "frame_index", "frame_idx",
                          "frameId", "frameNumber", "frameIndex")  # fmt: skip
"""Members with the number of a frame."""
HEADER_KEYS = either_case("header", "meta", "metadata")
"""Members with the time of a frame, as in messages of ROS."""
RATE_KEYS = (*either_case("fps", "frame_rate", "framerate", "frameRate"), "FPS")
NUMBERS_KEYS = either_case("frame_ids", "frameIds", "frame_numbers", "frame_indices")
"""Members with the numbers of all frames of a person."""
START_KEYS = either_case("start_frame", "startFrame")
"""Members with the number of the first frame of a person."""
SECOND_KEYS = ("sec", "secs", "seconds")
NANOSECOND_KEYS = ("nanosec", "nsec", "nsecs", "nanos", "nanoseconds")
"""Members with the rest of a time in ROS and Protocol Buffers, next to its whole seconds."""
MAX_NUMBER = 1e300
"""Maximum number or time of a frame, or rate in hertz. It guards the conversion of whole
numbers, which JSON does not limit."""
WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+")
PART = re.compile(r"(left|right|l|r)?(hands?|fingers?|faces?|mano)|lh|rh")
"""Word in the key of a part of a person."""
GEOMETRY = rb"[^\[]*\"(?:MultiLineString|(?:Multi)?Polygon)\""
"""Type of a geometry in GeoJSON, whose coordinates are nested like joints."""
LIST = rb"\[\s*(?:(?:(?>\[[\s\[\],]*\])|null)\s*,\s*)*"
"""The beginning of a list of frames; the first ones may have no people. The group is
atomic since empty lists can be split in very many ways."""
ROW = rb"\[(?:\s*-?\d[^,\[\]]*,){23}"
"""Numbers of a body in a row; matrices of something else are shorter."""
OBJECT = rb"(?:\[\s*)+\{\s*\"x\"\s*:"
HEAD = re.compile(
    rb"\s*(?:\{(?!"
    + GEOMETRY
    + rb")[^\[]*)?"
    + LIST
    + rb"(?:(?:\[\s*){2,}[-\d]|"
    + b"|".join((OBJECT, ROW))
    + rb")|\s*[\[{].*?\"("
    + "|".join(POINT_KEYS).encode()
    + rb')"\s*:\s*(\[\s*([\[{\d-]|null)|\{)|\s*[\[{].*?\"('
    + "|".join(LANDMARK_KEYS).encode()
    + rb')"\s*:\s*\[',
    re.DOTALL,
)
JOINT = re.compile(
    # The word begins the name, or follows a sign, a lower-case letter or a word of its own.
    rb"\"(?:[^\"]*(?:[^\"a-zA-Z]|(?<=[a-z])(?=[A-Z])))?"
    rb"(?i:left|right|upper|lower|up|low|fore|mid|[lr])*"
    rb"(?i:hips?|pelvis|spine|head|neck|nose|shoulder|arm|elbow|wrist|hand|leg|knee|ankle|foot|root)"
    rb"(?i:left|right|joint|center|top|base|tip)*(?![a-z])[^\"]*\"\s*:\s*"
    rb"(?:\{\s*\"(?i:pos\w*)\"\s*:\s*)?"
    rb"(?:\{\s*\"[xX]\"\s*:\s*\[?\s*\"?[-\d]"
    rb"|\[\s*(?:null\s*,\s*)*(?:\[\s*)?-?\d[^\s,\[\]]*(?:\s*,\s*-?\d[^\s,\[\]]*){2})"
)
NUMBERED = re.compile(rb"\s*\{\s*\"\w*\d\"\s*:\s*(\[\s*){2,}[-\d]")
"""The first frame of those that are keyed by their number."""
ONLY_EMPTY = re.compile(rb"\s*\[[\s\[\],nul]{1000,}")
"""The begin of a list whose first 1000 bytes are empty frames. Chosen by hand: it guards short
JSON of something else."""


class JsonPerson(NamedTuple):
    """A person of a frame, and the joints."""

    identity: str
    points: Points
    is_identified: bool = True
    """Whether the file says who it is; otherwise it is a place in a list."""


def is_frames_json(head: bytes) -> bool:
    """Return whether a file lists joints, from its first bytes."""
    if HEAD.match(head) or NUMBERED.match(head) or ONLY_EMPTY.fullmatch(head):
        return True
    return head.lstrip()[:1] in {b"{", b"["} and JOINT.search(head) is not None


def people_of_frame(frame: Any, key: str = "") -> Iterator[JsonPerson]:
    """Yield the people of a frame, which may be the element of a member with this key."""
    if isinstance(frame, list):
        yield from _listed_people(frame, key, "0")
    elif isinstance(frame, Mapping):
        people = (found for found in members(frame, PEOPLE_KEYS) if isinstance(found, list))
        listed = next(people, None)
        if listed is None:
            yield from _person(frame, name_of_body(frame, IDENTITY_KEYS, 0))
        else:
            yield from _listed_people(listed, key, "0")


def _listed_people(values: list[Any], key: str, identity: str) -> Iterator[JsonPerson]:
    """Yield who has the listed joints, or the people of a list by their places in it."""
    if points := points_of(values, key):
        yield JsonPerson(identity, points)
        return
    for count, body in enumerate(values):
        if isinstance(body, Mapping):
            name = name_of_body(body, NAMES_OF_PEOPLE, count)
            is_stated = name == name_of_body(body, NAMES_OF_PEOPLE, count + 1)
            people = [*_person(body, name)]
            if len(people) == 1:
                people = [people[0]._replace(identity=name, is_identified=is_stated)]
            yield from people
        elif isinstance(body, list) and (points := points_of(body, key)):
            yield JsonPerson(str(count), points, is_identified=False)


def _person(body: Mapping[str, Any], identity: str) -> Iterator[JsonPerson]:
    found = next((name for name in POINT_KEYS if body.get(name)), "")
    joints = body.get(found)
    if points := points_of(joints, found):
        yield JsonPerson(identity, points)
    elif isinstance(joints, list):
        is_alone = len(joints) == 1 and isinstance(joints[0], list)
        yield from _listed_people(joints[0] if is_alone else joints, found, identity)
    elif not joints:
        yield from _keyed_people(body, identity)


def _keyed_people(body: Mapping[str, Any], identity: str) -> Iterator[JsonPerson]:
    """Yield who has named positions of joints, or who is keyed by name or number."""
    body = {key: value for key, value in body.items() if not is_no_position(str(key))}
    nested = {key: value for key, value in body.items() if isinstance(value, Mapping)}
    bodies = {key: value for key, value in nested.items() if not has_word(key, PART.fullmatch)}
    for name, joints in {identity: body, **(bodies or nested)}.items():
        if any(map(joints.get, POINT_KEYS)):
            yield from (each._replace(identity=name) for each in _person(joints, name))
            continue
        positions = {str(key): position_of(value) for key, value in joints.items() if value}
        for width in (3, 4):
            found = {
                key: position
                for key, position in positions.items()
                if width_of(position) == width
            }
            points = points_of(found) if len(found) >= MIN_JOINTS else None
            if points is not None:
                yield JsonPerson(name, points)
                break


def has_word(key: str, is_meant: Callable[[str], object]) -> bool:
    """Return whether a word of a key is meant."""
    return any(is_meant(word.lower()) for word in WORD.findall(key))


def is_no_position(key: str) -> bool:
    """Return whether a key, such as `rotations`, is that of what has no positions."""
    singular = f"{key[:-3]}y" if key.endswith("ies") else key.removesuffix("s")
    return is_quantity(key) or is_quantity(singular)


def as_frame(value: Any) -> dict[str, Any]:
    """Return a frame as an object: a list is one of points or of people."""
    if isinstance(value, Mapping):
        return dict(value)
    is_body = isinstance(value, list) and points_of(value) is not None
    return {PEOPLE_KEYS[0]: [value] if is_body else value}


def time_of_frame(frame: Mapping[str, Any]) -> tuple[float, float | None]:
    """Return the time of a frame and its seconds per unit; NaN and None if it states none."""
    return next(iter(stamps_of_frame(frame).values()), (np.nan, None))


def stamps_of_frame(frame: Mapping[str, Any]) -> dict[str, tuple[float, float | None]]:
    """Return all times that a frame states, and their seconds per unit, by their keys.

    Whole seconds with nanoseconds next to them come first, without a key or below one, then
    names that state the unit, then others. Times in a header count if the frame has none.
    """
    headers = [each for each in members(frame, HEADER_KEYS) if isinstance(each, Mapping)]
    found = (_stamps_of_mapping(each) for each in (frame, *headers))
    return next(filter(None, found), {})


def _stamps_of_mapping(frame: Mapping[str, Any]) -> dict[str, tuple[float, float | None]]:
    names = {key: name for key in frame if (name := time_name(str(key))) is not None}
    split = {"": _joined_seconds(frame)} | {
        key: _joined_seconds(frame[key]) for key in names if isinstance(frame[key], Mapping)
    }
    stamps: dict[str, tuple[float, float | None]] = {
        key: (time, 1.0) for key, time in split.items() if np.isfinite(time)
    }
    for key in sorted(names, key=lambda key: names[key].second is None):
        time, second = read_time(frame[key], names[key].second)
        if np.isfinite(time):
            stamps[key] = time, second
    return stamps


def _joined_seconds(value: Mapping[str, Any]) -> float:
    """Return a time of whole seconds and nanoseconds; NaN if one of them is missing."""
    parts = (next(members(value, keys), None) for keys in (SECOND_KEYS, NANOSECOND_KEYS))
    seconds, rest = (read_time(part, None)[0] for part in parts)
    return seconds + 1e-9 * rest


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


def listed_times(value: Mapping[str, Any], n_frames: int) -> str:
    """Return the key of the times of all frames; empty if they have none."""
    for key, listed in value.items():
        if isinstance(listed, list) and len(listed) == n_frames and time_name(str(key)):
            times = {read_time(each, None)[0] for each in listed}
            if len(times) == n_frames and np.isfinite([*times]).all():
                return key
    return ""


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

    An object with joints or people is a frame, which may have the position of its camera, too.
    """
    if isinstance(value, Mapping) and not value.keys().isdisjoint((*POINT_KEYS, *PEOPLE_KEYS)):
        return False
    return value is None or width_of(position_of(value)) in {3, 4}
