"""Give the people of a file the same identity from the first to the last frame."""

from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import TypeVar

import numpy as np

from ...arrays import Array
from ...progress import Progress, Remark
from .follow_people import FollowedPeople, follow_people

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")
Subject = tuple[str, list[int], tuple[str, ...]]
ASSUMED_RATE_HZ = 30.0
"""Frames per second of a file without times, hertz, by definition of most trackers."""
MAX_LISTED = 5
"""Times that a sentence lists."""


def follow_bodies(
    frames: Sequence[Mapping[Key, Value]],
    points_of: Callable[[Value], Array],
    times: Array | None,
    progress: Progress,
) -> list[dict[Key, Value]]:
    """Return frames whose bodies have the identities of the persons (`follow_people`).

    Parameters
    ----------
    frames : sequence of mappings of identities to bodies
    points_of : callable
        Returns the points of a body, shape (n_joints, 3), NaN where not observed.
    times : shape (n_frames,), seconds; None or with NaN if unknown
    progress : Progress
        Receives how many switches were undone, and who was found again.
    """
    kept = [dict(frame) for frame in frames]
    if len(set().union(*frames)) < 2:
        return kept
    points = [{key: points_of(body) for key, body in frame.items()} for frame in frames]
    persons = _persons(points, times, progress)
    if persons is None:
        return kept
    return [
        {person[key]: body for key, body in frame.items()}
        for frame, person in zip(frames, persons, strict=True)
    ]


def follow_arrays(
    names: Sequence[str], bodies: Sequence[Array], times: Array | None, progress: Progress
) -> Sequence[Array]:
    """Return the points of bodies, each with that of one person in all frames.

    Parameters
    ----------
    names : of the bodies
    bodies : of shape (n_frames, n_joints, 3 or more), all the same; NaN where not observed
        Coordinates first.
    times : shape (n_frames,), seconds; None or with NaN if unknown
    progress : Progress
        Receives how many switches were undone, and who was found again.
    """
    if len(bodies) < 2 or bodies[0].shape[-1] < 3:
        return bodies
    present = [np.isfinite(body[..., :3]).all(axis=2).any(axis=1) for body in bodies]
    frames = [
        {
            name: body[frame, :, :3]
            for name, body, is_present in zip(names, bodies, present, strict=True)
            if is_present[frame]
        }
        for frame in range(len(bodies[0]))
    ]
    persons = _persons(frames, times, progress)
    if persons is None:
        return bodies
    index = {name: at for at, name in enumerate(names)}
    stacked = np.stack(bodies).astype(np.float64)
    found = np.full_like(stacked, np.nan)
    for frame, person_of in enumerate(persons):
        for name, person in person_of.items():
            found[index[person], frame] = stacked[index[name], frame]
    return [*found]


def follow_columns(
    subjects: Sequence[Subject], values: Array, times: Array | None, progress: Progress
) -> Array:
    """Return values in which the columns of a subject are those of one person in all frames.

    Subjects with other joints than the first one keep their columns.

    Parameters
    ----------
    subjects : name, columns and names of the joints of each
    values : shape (n_frames, n_columns, 3 or more), NaN where not observed
        Coordinates first.
    times, progress : as of `follow_arrays`
    """
    same = [each for each in subjects if {*each[2]} == {*subjects[0][2]}]
    if len(same) < 2:
        return values
    columns = [
        [column for _, column in sorted(zip(joints, own, strict=True))]
        for _, own, joints in same
    ]
    bodies = [values[:, own] for own in columns]
    followed = follow_arrays([name for name, _, _ in same], bodies, times, progress)
    if followed is bodies:
        return values
    found = values.copy()
    for own, body in zip(columns, followed, strict=True):
        found[:, own] = body
    return found


def _persons(
    points: Sequence[Mapping[Key, Array]], times: Array | None, progress: Progress
) -> list[dict[Key, Key]] | None:
    """Return the person of each identity in each frame; None where all are as in the file."""
    followed = follow_people(points, _increasing(times, len(points)))
    _report(followed, progress)
    return followed.persons if followed.is_changed else None


def _increasing(times: Array | None, n_frames: int) -> Array:
    """Return times that increase; those of the assumed rate if the file has none."""
    if times is not None and np.isfinite(times).all() and (np.diff(times) >= 0.0).all():
        return times
    return np.arange(n_frames) / ASSUMED_RATE_HZ


def _report(followed: FollowedPeople[Key], progress: Progress) -> None:
    """Report what was corrected, in a sentence each."""
    switches, found_again = followed.switch_times, followed.found_again
    if switches:
        times = _listed([f"{time:.2f} s" for time in switches])
        progress(
            0.8,
            Remark(f"Identity switches of the tracker, undone: {len(switches)} ({times})"),
        )
    if found_again:
        people = _listed([
            f"{_text(each.new)} = {_text(each.person)} ({each.time:.2f} s)"
            for each in found_again
        ])
        progress(0.8, Remark(f"People who were lost and have a new identity: {people}"))


def _listed(texts: list[str]) -> str:
    more = ", ..." if len(texts) > MAX_LISTED else ""
    return ", ".join(texts[:MAX_LISTED]) + more


def _text(key: Hashable) -> str:
    return key.decode("latin-1") if isinstance(key, bytes) else str(key)
