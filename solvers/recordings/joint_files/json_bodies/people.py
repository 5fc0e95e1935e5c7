"""Find the people in a frame of JSON, and their joints, however these are nested."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import islice
from typing import Any, NamedTuple

from ...point_bodies import is_quantity, key_of_root
from .bodies import StatedRoot, name_of_body
from .points import (
    LANDMARK_KEYS,
    MIN_JOINTS,
    Points,
    either_case,
    members,
    points_of,
    position_of,
    transform_of,
    width_of,
)

POINT_KEYS = (*LANDMARK_KEYS, *either_case(
    "keypoints3d", "keypoints_3d", "joints3d", "joints_3d", "joints3D", "3d_joints",
    "pose_keypoints_3d", "pose3d", "pose_3d", "poses_3d", "positions", "joints", "keypoints",
    "bones", "points", "xyz", "segments",
))  # fmt: skip
"""Members with the joints of a person."""
IN_WORLD = re.compile(
    r"(?i)(?:pose[_ ]?)?"
    r"(?:(?:world|3d)[_ ]?(?:key[_ ]?points|landmarks|points|joints|positions)"
    r"|(?:key[_ ]?points|landmarks|points|joints|positions)[_ ]?(?:in[_ ]?)?world)$"
)
"""Key of the joints of a person in the world, next to which others may be in a picture."""
PEOPLE_KEYS = either_case("instances", "people", "persons", "bodies", "skeletons",
                          "annots", "actors", "characters", "humans", "subjects",
                          "players", "users", "detections", "outputs")  # fmt: skip
"""Members with the people of a frame."""
IDENTITY_KEYS = either_case("id", "track_id", "person_id", "body_id", "personID",
                            "tracking_id", "trackingId")  # fmt: skip
NAMES_OF_PEOPLE = (*IDENTITY_KEYS, *either_case("name"))
"""Members with the identity of people in a list."""
LIST_OF_NAMES = ("joint_names", "jointNames", "names", "keypoint_names", "joints", "bones")
"""Members with the names of joints, where these stand apart."""
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
LISTED_POINT = re.compile(
    rb"\{(?:[^{}\[\]]{0,99}\"\w{1,99}\"\s{0,9}:\s{0,9}\{)?[^{}\[\]]{0,199}"
    rb"\"(?:p|pos)?[xX]\"\s*:\s*\"?-?\d[^{}\[\],]{0,99},\s{0,99}"
    rb"\"(?:p|pos)?[yY]\"[^{}\[\],]{0,99},\s{0,99}\"(?:p|pos)?[zZ]\"\s*:\s*\"?-?\d"
)
"""An object with x, y and z, or with one as its member."""
ROW_OF_POINTS = re.compile(
    rb"\"\w*(?:3d|3D|joint|Joint|kpt|Kpt|pose|Pose)\w*\"\s*:\s*\["
    rb"(?:\s*\[(?:\s*-?\d[^\s,\[\]]*\s*[,\]]){3}\s*,){7}"
)
"""Eight points of a member whose key is that of a pose, whatever it is called."""
ROW_OF_NUMBERS = re.compile(
    rb"\"\w*(?i:3d|joints?|kpts?|keypoints?)\d*\"\s*:\s*\[(?:\s*-?\d[^\s,\[\]]*\s*,){23}"
)
"""The same points as numbers in a row."""
ONLY_EMPTY = re.compile(rb"\s*\[[\s\[\],nul]{1000,}")
"""The begin of a list whose first 1000 bytes are empty frames. Chosen by hand: it guards short
JSON of something else."""


class JsonPerson(NamedTuple):
    """A person of a frame, and the joints."""

    identity: str
    points: Points
    is_identified: bool = True
    """Whether the file says who it is; otherwise it is a place in a list."""
    root: StatedRoot | None = None


def is_frames_json(head: bytes) -> bool:
    """Return whether a file lists joints, from its first bytes."""
    if HEAD.match(head) or NUMBERED.match(head) or ONLY_EMPTY.fullmatch(head):
        return True
    if head.lstrip()[:1] not in {b"{", b"["}:
        return False
    n_points = sum(1 for _ in islice(LISTED_POINT.finditer(head), MIN_JOINTS))
    rows = (ROW_OF_POINTS, ROW_OF_NUMBERS)
    is_listed = n_points == MIN_JOINTS or any(row.search(head) for row in rows)
    return is_listed or JOINT.search(head) is not None


def people_of_frame(frame: Any, key: str = "") -> Iterator[JsonPerson]:
    """Yield the people of a frame, which may be the element of a member with this key."""
    if isinstance(frame, list):
        yield from _listed_people(frame, key, "0")
    elif isinstance(frame, Mapping):
        people = (found for found in members(frame, PEOPLE_KEYS) if isinstance(found, list))
        listed = next(people, None)
        if listed is None:
            alone = [*_person(frame, name_of_body(frame, IDENTITY_KEYS, 0))]
            yield from alone or _people_of_scene(frame)
        else:
            found = [*_listed_people(listed, key, "0")]
            yield from _with_root(found, frame) if len(found) == 1 else found


def _with_root(people: Iterable[JsonPerson], body: Mapping[str, Any]) -> Iterator[JsonPerson]:
    """Yield people with the transform that is stated here, if they have none of their own."""
    root = _root_of(body)
    for each in people:
        yield each if each.root is not None else each._replace(root=root)


def _people_of_scene(frame: Mapping[str, Any]) -> Iterator[JsonPerson]:
    """Yield the people whom a member of a frame lists, such as its scene."""
    for inner in frame.values():
        if isinstance(inner, Mapping) and not inner.keys().isdisjoint(PEOPLE_KEYS):
            yield from people_of_frame(inner)


def _root_of(body: Mapping[str, Any]) -> StatedRoot | None:
    """Return where a person is, next to the joints; None if it is not stated."""
    key = key_of_root(map(str, body))
    transform = None if key is None else transform_of(body.get(key))
    return None if key is None or transform is None else StatedRoot(key, transform)


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
    found = _key_of_points(body)
    joints = body.get(found)
    if points := points_of(joints, found):
        names = points.names or _listed_names(body, len(points.positions))
        yield JsonPerson(identity, points._replace(names=names), root=_root_of(body))
    elif isinstance(joints, list):
        is_alone = len(joints) == 1 and isinstance(joints[0], list)
        people = _listed_people(joints[0] if is_alone else joints, found, identity)
        yield from _with_root(people, body)
    elif isinstance(joints, Mapping) and joints:
        yield from _person(joints, identity)
    else:
        yield from _keyed_people(body, identity)


def _listed_names(body: Mapping[str, Any], n_points: int) -> tuple[str, ...]:
    """Return the names of as many points that are listed next to them; else empty."""
    lists = (each for each in members(body, LIST_OF_NAMES) if isinstance(each, list))
    names = (each for each in lists if all(isinstance(name, str) for name in each))
    return tuple(next((each for each in names if len({*each}) == n_points == len(each)), ()))


def _key_of_points(body: Mapping[str, Any]) -> str:
    """Return the key of the joints of a person; empty without any.

    Points in the world come first, then keys in use for joints, then any list of points
    but those of hands and the face.
    """
    known = [name for name in POINT_KEYS if body.get(name)]
    in_world = [key for key in body if IN_WORLD.match(str(key)) and body[key]]
    if known or in_world:
        return (in_world or known)[0]
    lists = [key for key, value in body.items() if isinstance(value, list) and len(value) > 1]
    others = {*PEOPLE_KEYS, *filter(is_no_position, lists)}
    others |= {key for key in lists if has_word(key, PART.fullmatch)}
    found = [key for key in lists if key not in others and points_of(body[key]) is not None]
    return found[0] if found else ""


def _keyed_people(body: Mapping[str, Any], identity: str) -> Iterator[JsonPerson]:
    """Yield who has named positions of joints, or who is keyed by name or number."""
    body = {key: value for key, value in body.items() if not is_no_position(str(key))}
    nested = {key: value for key, value in body.items() if isinstance(value, Mapping)}
    bodies = {key: value for key, value in nested.items() if not has_word(key, PART.fullmatch)}
    for name, joints in ((identity, body), *(bodies or nested).items()):
        if any(map(joints.get, POINT_KEYS)):
            yield from (each._replace(identity=name) for each in _person(joints, name))
            continue
        widths = {key: width_of(position_of(value)) for key, value in joints.items() if value}
        for width in (3, 4):
            found = {key: joints[key] for key in widths if widths[key] == width}
            points = points_of(found) if len(found) >= MIN_JOINTS else None
            if points is not None:
                root = _root_of(joints) or _root_of(body)
                yield JsonPerson(name, points, root=root)
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
