"""Several people: together with one depth buffer, each component alone, and one person."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from solvers.depth_scene.actor import find_actor
from solvers.depth_scene.find_people import SeparatedPeople, find_people
from solvers.depth_scene.foreground import ForegroundMethod, ForegroundSettings, cut_out_actor
from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.model import BodyModel
from solvers.depth_tracking.capturing.capture import CaptureSettings, capture
from solvers.depth_tracking.several_bodies import capture_people

from ...shared.tables import Scores
from ..depth_sequences import errors
from .two_actors import SCENES, PeopleSequence, people_sequence

FORWARD = CaptureSettings(backward=False)
"""Half the run time; the peers are tracked in the same way."""
Found = list[np.ndarray]
"""Joints of each person that was found, (n_frames, 21, 3)."""


class Matched(NamedTuple):
    """A person that was found."""

    truth: int
    """Index of the true person who is nearest in most frames."""
    n_changes: int
    """How often the nearest true person changes."""


def people() -> list[str]:
    """Track two actors; bone lengths are known, first poses are not."""
    methods: dict[str, Callable[[PeopleSequence], Found]] = {
        "together, one depth buffer": _together,
        "each component alone": _alone,
        "one person": _one_person,
    }
    unit = f"{2 * len(SCENES)} people as clips; tracked forward, lengths known"
    scores = Scores("Two people", unit, "")
    by_person = Scores("Two people, by person, cm after offset", "one each", "")
    for name in SCENES:
        one = people_sequence(name)
        for label, method in methods.items():
            found = method(one)
            matches = [matched(joints, one) for joints in found]
            for person in range(len(one.joints)):
                figures = figures_of(person, found, matches, one)
                if "cm" in figures:
                    by_person.add(f"{name}, {'AB'[person]}", label, name, figures["cm"])
                for column, figure in figures.items():
                    scores.add(label, column, f"{name} {person}", figure)
    return [scores.markdown(), by_person.markdown()]


def figures_of(
    person: int, found: Found, matches: list[Matched], one: PeopleSequence
) -> dict[str, float]:
    """Return the figures of a true person, in the frames in which it is visible."""
    own = [
        (joints, match.n_changes)
        for joints, match in zip(found, matches, strict=True)
        if match.truth == person
    ]
    if not own:
        return {"not found": 1.0}
    joints, n_changes = own[0]
    seen = one.visible[person]
    off = errors(joints[seen], one.joints[person][seen])
    return off.figures() | {"identities exchanged": float(n_changes), "not found": 0.0}


def matched(joints: np.ndarray, one: PeopleSequence) -> Matched:
    """Return which true person was tracked, and how often that changed."""
    distances = np.linalg.norm(joints - one.joints, axis=-1).mean(axis=-1)
    distances = np.where(one.visible, distances, np.inf)
    nearest = distances.argmin(axis=0)[np.isfinite(distances).any(axis=0)]
    return Matched(int(np.bincount(nearest).argmax()), int((np.diff(nearest) != 0).sum()))


def bodies_of(found: SeparatedPeople, one: PeopleSequence) -> list[BodyModel]:
    """Return the true body of each person whose center was followed."""
    bodies = []
    for path in found.centers:
        distances = np.linalg.norm(path - one.joints[:, :, 0], axis=-1)
        distances = np.where(one.visible, distances, np.nan)
        bodies.append(one.body(int(np.nanmedian(distances, axis=1).argmin())))
    return bodies


def _together(one: PeopleSequence) -> Found:
    found = find_people(one.depth)
    captures = capture_people(found, bodies_of(found, one), settings=FORWARD)
    return [each.joints.positions for each in captures]


def _alone(one: PeopleSequence) -> Found:
    """Track the connected component nearest to each person's path, without occluders."""
    found = find_people(one.depth)
    settings = ForegroundSettings(actor_mask=ForegroundMethod.RECORDED)
    return [
        _captured(cut_out_actor(one.depth, settings, trajectory=path), body)
        for path, body in zip(found.centers, bodies_of(found, one), strict=True)
    ]


def _one_person(one: PeopleSequence) -> Found:
    actor = find_actor(one.depth)
    largest = int(one.pixels.sum(axis=1).argmax())
    return [_captured(actor.recording, one.body(largest))]


def _captured(depth: DepthRecording, body: BodyModel) -> np.ndarray:
    return capture(depth, body, settings=FORWARD).joints.positions
