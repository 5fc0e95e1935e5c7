"""What every verb promises, whatever it does: one battery, as scikit-learn has for estimators.

To add a verb, add a line to `VERBS`.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising import (
    DenoiseSettings,
    FilterBases,
    JointLimits,
    Method,
    denoise,
    find_worst_spots,
    keep_within,
    learn_filter_bases,
    learn_joint_limits,
    measure_quality,
    plant_feet,
)
from solvers.denoising.quality import mean_jitter
from solvers.errors import SolveCancelled
from solvers.motion import Motion, Tracks, detect_contacts, forward_kinematics, resample
from solvers.motion.rotations import angle_between, multiply, quaternion_from_rotation_vector
from solvers.progress import Progress, unwatched
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait

QUARTER_TURN, SHIFT = np.radians(100.0), np.array([2.0, -5.0, 0.0])


@dataclass(frozen=True)
class Verb:
    """How the battery calls a verb, and what of its result the laws are about."""

    call: Callable[[Motion, Progress], Any]
    recording: Callable[[Any], Motion | Tracks | None] = lambda result: None
    """What moves with the input and is the same motion at any frame rate."""
    figures: Callable[[Any], Any] = lambda result: ()
    """What stays as it is when the input is moved and turned."""
    whole_input: bool = False
    """It wants a motion without gaps."""
    reports: bool = True
    """It takes `progress`."""
    any_rate: bool = False
    """It returns a motion, which must be the same at any frame rate."""


VERBS = {
    "denoise": Verb(
        lambda motion, progress: denoise(motion, progress=progress),
        recording=lambda result: result.recording,
        figures=lambda result: (result.outliers, result.confidence),
        any_rate=True,
    ),
    "denoise tracks": Verb(
        lambda motion, progress: denoise(points_of(motion), progress=progress),
        recording=lambda result: result.recording,
        figures=lambda result: (result.outliers, result.confidence),
        any_rate=True,
    ),
    "denoise with bases": Verb(
        lambda motion, progress: denoise(motion, bases(), progress=progress),
        recording=lambda result: result.recording,
        figures=lambda result: (result.outliers, result.confidence),
        any_rate=True,
    ),
    "denoise as published": Verb(
        lambda motion, progress: denoise(
            motion,
            bases(),
            settings=DenoiseSettings(method=Method.PUBLISHED),
            progress=progress,
        ),
        recording=lambda result: result.recording,
    ),
    "learn_filter_bases": Verb(
        lambda motion, progress: learn_filter_bases([motion], progress=progress),
        figures=lambda result: (result.mean, result.values),
    ),
    "measure_quality": Verb(
        lambda motion, progress: measure_quality(motion, progress=progress),
        figures=lambda result: (result.jitter, result.spikes, result.gaps),
    ),
    "find_worst_spots": Verb(
        lambda motion, progress: find_worst_spots(motion, progress=progress),
        figures=lambda result: result,
    ),
    "learn_joint_limits": Verb(
        lambda motion, progress: learn_joint_limits([motion], progress=progress),
        figures=lambda result: (result.names, result.upper - result.lower),
    ),
    "keep_within": Verb(
        lambda motion, progress: keep_within(motion, limits()),
        recording=lambda result: result,
        reports=False,
        any_rate=True,
    ),
    "plant_feet": Verb(
        lambda motion, progress: plant_feet(motion, progress=progress),
        recording=lambda result: result.motion,
        figures=lambda result: (result.contacts, result.slide_before),
        whole_input=True,
        any_rate=True,
    ),
    "resample": Verb(
        lambda motion, progress: resample(motion, 40.0),
        recording=lambda result: result,
        reports=False,
    ),
    "detect_contacts": Verb(
        lambda motion, progress: detect_contacts(motion),
        figures=lambda result: result,
        whole_input=True,
        reports=False,
    ),
}
WALK = GaitSettings(duration=2.0, frame_rate=30.0)
WRONG = CorruptionSettings(jitter=2.0, spikes=0.003, root_jitter=0.003)
LOST = {"LeftForeArm": range(20, 40)}
LEG = ("UpLeg", "Leg", "Foot", "ToeBase", "ToeBase_end")
JOINTS = {"Hips", "Spine", "Spine2", "Head", "LeftArm", "LeftForeArm"} | {
    side + part for side in ("Left", "Right") for part in LEG
}
"""Enough of a body for every verb, and quick."""

every_verb = pytest.mark.parametrize("name", VERBS)
every_verb_that_reports = pytest.mark.parametrize(
    "name", [name for name, verb in VERBS.items() if verb.reports]
)
every_verb_that_returns_a_motion = pytest.mark.parametrize(
    "name", [name for name, verb in VERBS.items() if verb.any_rate]
)


@every_verb
def test_leaves_its_input_unchanged_and_shares_no_memory_with_it(name):
    motion = spoilt(name)
    rotations, places = motion.rotations.copy(), motion.root_positions.copy()

    result = VERBS[name].call(motion, unwatched)

    assert np.array_equal(motion.rotations, rotations, equal_nan=True)
    assert np.array_equal(motion.root_positions, places, equal_nan=True)
    for value in values_in(result):
        for array in (motion.rotations, motion.root_positions):
            assert not (isinstance(value, np.ndarray) and np.shares_memory(value, array))


@every_verb
def test_gives_the_same_result_again(name):
    first, again = values_in(usual_result(name)), values_in(new_result(name))

    assert len(first) == len(again) > 0
    for one, other in zip(first, again, strict=True):
        assert np.array_equal(one, other, equal_nan=np.asarray(one).dtype.kind == "f")


@every_verb_that_reports
def test_its_progress_rises_from_0_to_1(name):
    told = []

    VERBS[name].call(spoilt(name), lambda fraction, message="": told.append(fraction))

    assert told[-1] == pytest.approx(1.0)
    assert told[0] >= 0.0 and (np.diff(told) >= -1e-12).all()


@every_verb_that_reports
@pytest.mark.parametrize("report", [0])
def test_stops_at_the_report_at_which_it_is_cancelled(name, report):
    told = []

    def cancel(fraction: float, message: str = "") -> None:
        told.append(fraction)
        if len(told) > report:
            raise SolveCancelled

    with pytest.raises(SolveCancelled):
        VERBS[name].call(spoilt(name), cancel)
    assert len(told) == report + 1


@every_verb
def test_moves_and_turns_with_its_input(name):
    verb, here = VERBS[name], usual_result(name)

    there = verb.call(carried(spoilt(name)), unwatched)

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
def test_gives_the_same_motion_at_60_and_120_hertz(name):
    """A gap is filled in the same way, and what is clean stays, whatever the sampling."""
    verb = VERBS[name]
    slow, fast = (
        verb.recording(verb.call(clean(name, rate), unwatched)) for rate in (60.0, 120.0)
    )

    assert_same(every_second(fast), slow, 1.5, 0.01)


@every_verb_that_returns_a_motion
def test_does_not_make_a_clean_take_shake(name):
    """At 120 Hz, where a filter that treats neighbouring frames apart would show; white noise
    of a tenth of a millimetre is allowed, whose third differences come to 770 m/s^3.
    """
    walk = walk_of_few_joints(GaitSettings(duration=2.0, frame_rate=120.0))

    result = VERBS[name].recording(VERBS[name].call(walk, unwatched))

    assert jitter(result) < jitter(walk) + 770.0


@cache
def bases() -> FilterBases:
    clips = [GaitSettings(duration=4.0, frame_rate=30.0, seed=seed) for seed in (1, 2)]
    return learn_filter_bases([walk_of_few_joints(clip) for clip in clips])


@cache
def limits() -> JointLimits:
    return learn_joint_limits([walk_of_few_joints(WALK)])


@cache
def usual_result(name: str) -> Any:
    return new_result(name)


def new_result(name: str) -> Any:
    return VERBS[name].call(spoilt(name), unwatched)


def jitter(recording: Motion | Tracks) -> float:
    points = recording if isinstance(recording, Tracks) else points_of(recording)
    return float(mean_jitter(points.positions, points.frame_rate).mean())


def spoilt(name: str) -> Motion:
    missing = {} if VERBS[name].whole_input else LOST
    return corrupt(walk_of_few_joints(WALK), WRONG, missing=missing)


def clean(name: str, frame_rate: float) -> Motion:
    walk = walk_of_few_joints(GaitSettings(duration=2.0, frame_rate=frame_rate))
    gap = (
        {}
        if VERBS[name].whole_input
        else {"LeftArm": range(round(frame_rate), round(1.4 * frame_rate))}
    )
    return corrupt(walk, CorruptionSettings(jitter=0.0), missing=gap)


def walk_of_few_joints(settings: GaitSettings) -> Motion:
    walk = walking_gait(settings)
    joints = [n for n, name in enumerate(walk.skeleton.names) if name in JOINTS]
    skeleton = walk.skeleton.select(joints)
    return Motion(skeleton, walk.rotations[:, joints], walk.root_positions, walk.frame_rate)


def points_of(motion: Motion) -> Tracks:
    return Tracks(
        motion.skeleton.names, forward_kinematics(motion).positions, motion.frame_rate
    )


def carried(recording: Motion | Tracks) -> Motion | Tracks:
    """The same recording elsewhere on the floor, facing another way."""
    turn = quaternion_from_rotation_vector([0.0, 0.0, QUARTER_TURN])
    cosine, sine = np.cos(QUARTER_TURN), np.sin(QUARTER_TURN)
    matrix = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
    if isinstance(recording, Tracks):
        return recording.with_positions(recording.positions @ matrix.T + SHIFT)
    rotations = recording.rotations.copy()
    rotations[:, 0] = multiply(turn, rotations[:, 0])
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


def assert_same(one: Motion | Tracks, other: Motion | Tracks, degrees: float, metres: float):
    """Mean over frames of the worst joint within `degrees`, or the worst point in `metres`."""
    if isinstance(one, Tracks):
        apart = np.linalg.norm(one.positions - other.positions, axis=-1)
        assert np.nanmean(apart, axis=0).max() < metres
        return
    angles = np.degrees(angle_between(one.rotations, other.rotations))
    assert np.nanmean(angles, axis=0).max() < degrees
    assert np.abs(one.root_positions - other.root_positions).mean() < metres


def values_in(result: Any) -> list[Any]:
    """All arrays, numbers and words in nested dataclasses and sequences."""
    if is_dataclass(result):
        return [
            value for item in fields(result) for value in values_in(getattr(result, item.name))
        ]
    if isinstance(result, (list, tuple)):
        return [value for each in result for value in values_in(each)]
    return [result]
