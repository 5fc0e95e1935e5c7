"""Read the JSON of body trackers whose files hold the joints of several people per frame."""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ....arrays import Array
from ....errors import InvalidFileError
from ....motion import JointRecording
from ....progress import Progress
from ...containers import array_from_json, json_members
from ...conventions import (
    DEFAULT_FRAME_RATE,
    Bodies,
    bodies_of_frames,
    no_body_error,
    path_from_camera,
    recorded_seconds,
)
from ...identities import follow_bodies
from ...point_bodies import as_fractions


class StatedRoot(NamedTuple):
    """Where a person is in one frame, next to the joints."""

    key: str
    """Of the member that states it."""
    transform: Array
    """Shape (4, 4), which joints may be relative to."""


class BodyJoints(NamedTuple):
    """Joints of one person in one frame."""

    positions: Array
    """Shape (n_joints, 3)."""
    confidence: Array
    """Shape (n_joints,), NaN where the file has none."""
    names: tuple[str, ...] = ()
    """Of the joints, where they may be others in each frame; otherwise empty."""
    root: StatedRoot | None = None


class BodiesFrame(NamedTuple):
    """One frame of a file."""

    time: float
    """In the unit of the file; NaN if it is not stated."""
    bodies: dict[str, BodyJoints]
    done: float
    """Fraction of the file up to its end."""


def json_frames(path: Path | str, keys: frozenset[str]) -> Iterator[tuple[str, Any, float]]:
    """Yield key, value and fraction of the file of each object that has one of these keys.

    Frames are elements of a list, or members of the outermost object, by time.
    """
    for member in json_members(path, lists=True):
        if isinstance(member.value, dict) and not keys.isdisjoint(member.value):
            yield member.key, member.value, member.done


def open_frames(
    path: Path | str,
    frames: list[BodiesFrame],
    second: float,
    read: Callable[[list[BodiesFrame], str, Array | None, Progress], JointRecording],
    progress: Progress,
) -> Bodies[JointRecording]:
    """List the bodies of the frames of a file, whose identities may be swapped.

    Parameters
    ----------
    path : Path or str
    frames : list of BodiesFrame
    second : float
        Seconds per unit of the time stamps.
    read : callable
        Returns the recording of a body, by the frames, its identity and the times in seconds,
        which are None where the file has none.
    progress : Progress

    Raises
    ------
    InvalidFileError
        No frame has a body.
    """
    found = [frame.bodies for frame in frames]
    if not any(found):
        raise no_body_error(path)
    stamps = second * np.array([frame.time for frame in frames])
    times = None if np.isnan(stamps).all() else stamps
    duration = len(frames) / DEFAULT_FRAME_RATE if times is None else recorded_seconds(stamps)
    found = follow_bodies(found, _points_by_name(found), times, progress)
    followed = [
        frame._replace(bodies=bodies) for frame, bodies in zip(frames, found, strict=True)
    ]
    identities, people = bodies_of_frames(found, duration)
    return Bodies(
        str(path),
        people,
        lambda index, progress: read(followed, identities[index], times, progress),
    )


def _points_by_name(frames: list[dict[str, BodyJoints]]) -> Callable[[BodyJoints], Array]:
    """Return a function that gives each joint of a body the same index in all frames.

    Bodies with ever other names have no points.
    """
    found = [joints.names for frame in frames for joints in frame.values()]
    names = dict.fromkeys(name for each in dict.fromkeys(found) for name in each)
    columns = {name: column for column, name in enumerate(names)}
    has_same_names = len(columns) <= 2 * max(map(len, found), default=0)

    def points_of(joints: BodyJoints) -> Array:
        if not joints.names:
            return joints.positions
        if not has_same_names:
            return joints.positions[:0]
        points = np.full((len(columns), 3), np.nan)
        points[[columns[name] for name in joints.names]] = joints.positions
        return points

    return points_of


def checked_objects(value: Any, location: str) -> list[Any]:
    """Return a list of objects; raise InvalidFileError for other values."""
    if value is None:
        return []
    if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
        raise InvalidFileError(
            f"{location}: a list of bodies is required. The file is damaged; export it again."
        )
    return value


def number(value: Any, location: str) -> float:
    """Return a number, which may be a text; NaN for null."""
    return float(array_from_json(value, (), location))


def point(value: Any, location: str) -> Array:
    """Return (3,) from a list of x, y, z or from an object with these keys."""
    if isinstance(value, Mapping):
        lower = {str(key).lower(): coordinate for key, coordinate in value.items()}
        value = [lower.get(axis) for axis in "xyz"]
    return array_from_json(value, (3,), location)


def stack_body(body: str, frames: list[BodiesFrame]) -> tuple[Array, Array | None]:
    """Return positions, (F, n, 3), and confidence, (F, n), of a body; NaN and 0 without it.

    Raises ValueError if it has different joints in different frames.
    """
    found = [frame.bodies.get(body) for frame in frames]
    empty = next(each for each in found if each is not None)
    gap = BodyJoints(
        np.full_like(empty.positions, np.nan), np.full_like(empty.confidence, np.nan)
    )
    positions = np.stack([(each or gap).positions for each in found])
    confidence = np.stack([(each or gap).confidence for each in found])
    return positions, as_fractions(confidence, positions)


def roots_of(body: str, frames: list[BodiesFrame], progress: Progress) -> Array | None:
    """Return the transforms of a body, (n_frames, 4, 4), NaN where missing, or None.

    What is known of a path that is relative to a camera follows from all frames
    (`path_from_camera`); `progress` receives what is left out.
    """
    found = [frame.bodies[body].root if body in frame.bodies else None for frame in frames]
    key = next((root.key for root in found if root is not None), None)
    if key is None:
        return None
    missing = np.full((4, 4), np.nan)
    roots: Array = np.stack([missing if root is None else root.transform for root in found])
    roots[:, :3, 3], limited = path_from_camera(key, roots[:, :3, 3])
    if limited:
        progress(0.1, limited)
    return roots


def name_of_body(body: Mapping[str, Any], keys: tuple[str, ...], count: int) -> str:
    """Return the identity of a body, or its index in the frame if it has none.

    A body whose identity is -1 or null is `untracked` with that index: others have identities,
    among them perhaps that number.
    """
    stated = [body[key] for key in keys if key in body]
    known = (identity for identity in stated if identity not in (None, -1, [-1]))
    return str(next(known, f"untracked {count}" if stated else count))
