"""Split named points into subjects: persons and props whose names begin the labels."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from ...motion import JointRecording, Tracks
from ...progress import Progress
from ..identities import follow_columns
from .axes import MIN_BODY_JOINTS
from .bodies import Bodies, observed_body
from .points import point_names

Recording = TypeVar("Recording", Tracks, JointRecording)
SEPARATOR, UNDERSCORE = ":", "_"
SIDE_WORDS = frozenset({"l", "r", "left", "right", "lt", "rt"})
"""Words before an underscore that are sides rather than people."""
SIDES_OF_WORDS = (("l", "r"), ("left", "right"), ("lt", "rt"))
MIN_SHARED_FRACTION = 0.7
"""Fraction of the markers of two people that have the same names. Chosen by hand: people of one
recording wear one set, where single markers differ or are missing."""
UNLABELED = "unlabeled"
"""Name of the points of no subject, if others have one."""
MIN_PERSON_MARKERS = 12
"""Number of markers of a person. Measured: the smallest common sets, of legs alone, have 15;
clusters on single segments, boxes and balls have fewer."""
MAX_RIGID_CHANGE_M = 0.02
"""Maximum change of nine in ten distances between markers of a rigid prop, meters. Measured: in
Vicon's example the largest change is 0.07 cm for a box and 60 cm for the person who holds
it."""
MAX_COMPARED_FRAMES = 500
"""Frames that are compared to find props. It bounds the run time."""
MAX_PAIRED_MARKERS = 50
"""Markers of a subject whose distances are compared. It bounds the run time."""


class MarkerSubject(NamedTuple):
    """Points of one person or prop."""

    name: str
    columns: list[int]
    names: tuple[str, ...]
    """Of its points, without its own name."""


def split_subjects(labels: Sequence[str]) -> list[MarkerSubject]:
    """Return the subjects that begin labels, such as Anna in `Anna:LFHD`; or one of all points.

    Where no label has a colon, `Anna_LFHD` and `Ben_LFHD` are two people with the same markers.
    Points of no subject come last.
    """
    separator = SEPARATOR
    if not any(SEPARATOR in label for label in labels) and _are_people(labels):
        separator = UNDERSCORE
    found: dict[str, list[int]] = {}
    for column, label in enumerate(labels):
        found.setdefault(_split(label, separator)[0], []).append(column)
    unlabeled = found.pop("", [])
    if len(found) < 2:
        return [MarkerSubject("1", list(range(len(labels))), point_names(labels))]
    subjects = [
        MarkerSubject(
            name, columns, point_names([_split(labels[each], separator)[1] for each in columns])
        )
        for name, columns in found.items()
    ]
    if unlabeled:
        names = point_names([labels[each] for each in unlabeled])
        subjects.append(MarkerSubject(UNLABELED, unlabeled, names))
    return subjects


def _split(label: str, separator: str) -> tuple[str, str]:
    """Return the subject and the name of a label; subjects end at the last colon."""
    if separator == SEPARATOR:
        subject, _, name = label.rpartition(separator)
        return subject, name
    subject, found, name = label.partition(separator)
    return (subject, name) if found and name else ("", label)


def _are_people(labels: Sequence[str]) -> bool:
    """Return whether words before an underscore are people, who wear the same markers."""
    worn: dict[str, set[str]] = {}
    for label in labels:
        subject, name = _split(label, UNDERSCORE)
        if subject and subject.lower() not in SIDE_WORDS and not name.isdigit():
            worn.setdefault(subject, set()).add(name)
    people = [person for person in worn if len(worn[person]) >= MIN_PERSON_MARKERS]
    return any(
        len(worn[one] & worn[other])
        >= MIN_SHARED_FRACTION * min(len(worn[one]), len(worn[other]))
        for one, other in combinations(people, 2)
        if not _are_sides(one, other)
    )


def _are_sides(one: str, other: str) -> bool:
    """Return whether two words end as sides do, such as LL and LR of the actor L."""
    pair = one.lower(), other.lower()
    return any(
        pair[0].removesuffix(left) == pair[1].removesuffix(right) and pair[0] != pair[1]
        for left, right in (*SIDES_OF_WORDS, *(sides[::-1] for sides in SIDES_OF_WORDS))
        if pair[0].endswith(left) and pair[1].endswith(right)
    )


def bodies_of_markers(path: object, tracks: Tracks, labels: Sequence[str]) -> Bodies[Tracks]:
    """Return the subjects of labeled markers; where only one is a person, all are together."""

    def is_person(subject: MarkerSubject) -> bool:
        if subject.name == UNLABELED or len(subject.columns) < MIN_PERSON_MARKERS:
            return False
        return not _is_rigid(tracks.positions[:, subject.columns])

    return _bodies(path, tracks, tracks, split_subjects(labels), is_person, _marker_columns)


def bodies_of_joints(
    path: object, recording: JointRecording, progress: Progress
) -> Bodies[JointRecording]:
    """Return the subjects of named joints; where only one is a person, all are together."""

    def is_person(subject: MarkerSubject) -> bool:
        return subject.name != UNLABELED and len(subject.columns) >= MIN_BODY_JOINTS

    subjects = split_subjects(recording.names)
    recording = _with_people_followed(recording, list(filter(is_person, subjects)), progress)
    tracks = recording.tracks
    return _bodies(path, recording, tracks, subjects, is_person, _joint_columns)


def _with_people_followed(
    recording: JointRecording, people: list[MarkerSubject], progress: Progress
) -> JointRecording:
    """Return a recording in which swapped people are swapped back (`follow_columns`)."""
    tracks, states = recording.tracks, recording.tracking_state
    others = [each[..., None] for each in (tracks.confidence, states) if each is not None]
    values = np.concatenate([tracks.positions, *others], axis=2)
    times = np.arange(tracks.n_frames) / tracks.frame_rate
    followed = follow_columns(people, values, times, progress)
    if followed is values:
        return recording
    columns = iter(np.moveaxis(np.nan_to_num(followed[..., 3:]), 2, 0))
    confidence = None if tracks.confidence is None else next(columns)
    return JointRecording(
        replace(tracks, positions=followed[..., :3], confidence=confidence),
        None if states is None else next(columns).astype(states.dtype),
        recording.sensor,
    )


def _bodies(
    path: object,
    recording: Recording,
    tracks: Tracks,
    subjects: list[MarkerSubject],
    is_person: Callable[[MarkerSubject], bool],
    select: Callable[[Recording, MarkerSubject], Recording],
) -> Bodies[Recording]:
    duration_s = tracks.n_frames / tracks.frame_rate
    visible = tracks.visible
    listed = tuple(
        observed_body(
            subject.name,
            np.flatnonzero(visible[:, subject.columns].any(axis=1)),
            tracks.n_frames,
            duration_s,
            is_person=len(subjects) == 1 or is_person(subject),
        )
        for subject in subjects
    )

    def read(index: int, progress: Progress) -> Recording:
        return recording if len(subjects) == 1 else select(recording, subjects[index])

    return Bodies(str(path), listed, read, lambda progress: recording)


def _marker_columns(tracks: Tracks, subject: MarkerSubject) -> Tracks:
    columns, confidence = subject.columns, tracks.confidence
    return Tracks(
        subject.names,
        tracks.positions[:, columns],
        tracks.frame_rate,
        None if confidence is None else confidence[:, columns],
        tracks.conventions,
    )


def _joint_columns(recording: JointRecording, subject: MarkerSubject) -> JointRecording:
    states = recording.tracking_state
    return JointRecording(
        _marker_columns(recording.tracks, subject),
        None if states is None else states[:, subject.columns],
        recording.sensor,
    )


def _is_rigid(points: NDArray[np.float64]) -> bool:
    """Return whether points move, but never relative to each other; (n_frames, n_points, 3)."""
    points = points[:: max(1, len(points) // MAX_COMPARED_FRAMES)]
    observed = points[:, np.isfinite(points).all(axis=-1).any(axis=0)][:, :MAX_PAIRED_MARKERS]
    if observed.shape[1] < 2:
        return False
    moved = np.nanmax(observed, axis=0) - np.nanmin(observed, axis=0)
    one, other = np.triu_indices(observed.shape[1], 1)
    distances = np.linalg.norm(observed[:, one] - observed[:, other], axis=-1)
    is_observed = np.isfinite(distances).any(axis=0)
    if not is_observed.any():
        return False
    low, high = np.nanquantile(distances[:, is_observed], [0.05, 0.95], axis=0)
    is_still = float(moved.max()) < MAX_RIGID_CHANGE_M
    return not is_still and float(np.quantile(high - low, 0.9)) < MAX_RIGID_CHANGE_M
