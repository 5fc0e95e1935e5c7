"""What every verb promises, whatever it does: one battery, as scikit-learn has for estimators.

The verbs stand in `contract_verbs.py`; to add one, add a line there.
"""

from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.denoising.quality.jitter import measure_jitter
from solvers.errors import SolveCancelled
from solvers.motion import Motion, Tracks
from solvers.progress import unwatched
from solvers.rotations.representations import (
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
)
from solvers.samples import GaitSettings
from tests.solvers.contract_verbs import VERBS, clean, damaged, points_of, walk_of_few_joints

ROTATION_RAD, SHIFT = np.radians(100.0), np.array([2.0, -5.0, 0.0])

every_verb = pytest.mark.parametrize("name", VERBS)
every_verb_that_reports = pytest.mark.parametrize(
    "name", [name for name, verb in VERBS.items() if verb.reports]
)
every_verb_that_returns_a_motion = pytest.mark.parametrize(
    "name", [name for name, verb in VERBS.items() if verb.any_rate]
)


@every_verb
def test_solver_does_not_change_or_alias_its_input(name):
    solved, motion = first_solve(name), damaged(name)

    assert np.array_equal(solved.given.rotations, motion.rotations, equal_nan=True)
    assert np.array_equal(solved.given.root_positions, motion.root_positions, equal_nan=True)
    for value in values_in(solved.result):
        for array in (solved.given.rotations, solved.given.root_positions):
            assert not (isinstance(value, np.ndarray) and np.shares_memory(value, array))


@every_verb
def test_solver_repeats_its_result(name):
    """Whether or not anything listens to its progress."""
    first = values_in(first_solve(name).result)

    again = values_in(VERBS[name].call(damaged(name), unwatched))

    assert len(first) == len(again) > 0
    for one, other in zip(first, again, strict=True):
        assert_array_equal(other, one)


@every_verb_that_reports
def test_solver_progress_rises_from_0_to_1(name):
    fractions = first_solve(name).fractions

    assert fractions[-1] == pytest.approx(1.0)
    assert fractions[0] >= 0.0 and (np.diff(fractions) >= -1e-12).all()


@every_verb_that_reports
@pytest.mark.parametrize("report", [0])
def test_solver_stops_when_cancelled(name, report):
    fractions = []

    def cancel(fraction: float, message: str = "") -> None:
        fractions.append(fraction)
        if len(fractions) > report:
            raise SolveCancelled

    with pytest.raises(SolveCancelled):
        VERBS[name].call(damaged(name), cancel)
    assert len(fractions) == report + 1


@every_verb
def test_solver_is_equivariant_to_translation_and_rotation(name):
    verb, here = VERBS[name], first_solve(name).result

    there = verb.call(carried(damaged(name)), unwatched)

    for one, other in zip(
        values_in(verb.figures(here)), values_in(verb.figures(there)), strict=True
    ):
        if np.asarray(one).dtype.kind in "bif":
            assert_allclose(other, one, atol=1e-5, rtol=1e-5)
        else:
            assert other == one
    if verb.recording(here) is not None:
        assert_same(verb.recording(there), carried(verb.recording(here)), 0.01, 1e-4)


@every_verb_that_returns_a_motion
def test_solver_gives_the_same_motion_at_60_and_120_hertz(name):
    """A gap is filled equally, and clean samples stay, at any frame rate."""
    verb = VERBS[name]
    slow, fast = (
        verb.recording(verb.call(clean(name, rate), unwatched)) for rate in (60.0, 120.0)
    )

    assert_same(every_second(fast), slow, 1.5, 0.01)


@every_verb_that_returns_a_motion
def test_solver_does_not_add_jitter_to_a_clean_take(name):
    """At 120 Hz, where a filter that treats neighboring frames separately would show; white
    noise of a tenth of a millimeter is allowed, whose third differences come to 770 m/s^3.
    """
    walk = walk_of_few_joints(GaitSettings(duration=2.0, frame_rate=120.0))

    result = VERBS[name].recording(VERBS[name].call(walk, unwatched))

    assert jitter(result) < jitter(walk) + 770.0


class Solve(NamedTuple):
    """A solve whose input and reports were kept."""

    given: Motion
    """The object that the verb was called with, not a copy."""
    result: Any
    fractions: list[float]


@cache
def first_solve(name: str) -> Solve:
    """Solve the damaged take, once for the laws that can share a solve."""
    given, fractions = damaged(name), []
    result = VERBS[name].call(given, lambda fraction, message="": fractions.append(fraction))
    return Solve(given, result, fractions)


def jitter(recording: Motion | Tracks) -> float:
    points = recording if isinstance(recording, Tracks) else points_of(recording)
    return float(measure_jitter(points.positions, points.frame_rate).mean())


def carried(recording: Motion | Tracks) -> Motion | Tracks:
    """The same recording elsewhere on the floor, facing another way."""
    rotation = quaternion_from_rotation_vector([0.0, 0.0, ROTATION_RAD])
    cosine, sine = np.cos(ROTATION_RAD), np.sin(ROTATION_RAD)
    matrix = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
    if isinstance(recording, Tracks):
        return recording.with_positions(recording.positions @ matrix.T + SHIFT)
    rotations = recording.rotations.copy()
    rotations[:, 0] = multiply(rotation, rotations[:, 0])
    return recording.with_poses(rotations, recording.root_positions @ matrix.T + SHIFT)


def every_second(recording: Motion | Tracks) -> Motion | Tracks:
    if isinstance(recording, Tracks):
        return Tracks(recording.names, recording.positions[::2], recording.frame_rate / 2)
    return Motion(
        recording.skeleton,
        recording.rotations[::2],
        recording.root_positions[::2],
        recording.frame_rate / 2,
    )


def assert_same(one: Motion | Tracks, other: Motion | Tracks, degrees: float, meters: float):
    """Mean over frames of the worst joint within `degrees`, or the worst point in `meters`."""
    if isinstance(one, Tracks):
        distances = np.linalg.norm(one.positions - other.positions, axis=-1)
        assert np.nanmean(distances, axis=0).max() < meters
        return
    angles = np.degrees(angle_between(one.rotations, other.rotations))
    assert np.nanmean(angles, axis=0).max() < degrees
    assert np.abs(one.root_positions - other.root_positions).mean() < meters


def values_in(result: Any) -> list[Any]:
    """All arrays, numbers and words in nested dataclasses and sequences."""
    if is_dataclass(result):
        return [
            value for item in fields(result) for value in values_in(getattr(result, item.name))
        ]
    if isinstance(result, (list, tuple)):
        return [value for each in result for value in values_in(each)]
    return [result]
