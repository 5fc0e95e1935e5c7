"""Denoising: eight corrupted takes, with examples and without."""

from typing import NamedTuple

import numpy as np

from solvers.arrays import Flags
from solvers.denoising import (
    Denoised,
    denoise,
    learn_filter_bases,
    learn_joint_limits,
)
from solvers.motion import Motion, Skeleton, Tracks
from solvers.rotations.representations import angle_between
from solvers.samples import CorruptionSettings, corrupt

from ..takes import (
    angle_error,
    hdm05,
    joint_tracks,
    missed_or_false,
    point_error,
    pruned,
    root_error,
    thrown_off,
    variety,
    walk,
)

EXAMPLES = ("10_04", "27_01", "32_01", "07_11")
MIN_OUTLIER = 15.0
"""Degrees between the given and the true rotation of what counts as a spike."""


class Case(NamedTuple):
    """A corrupted take and what Clean is given with it."""

    truth: Motion
    given: Motion
    examples: bool = False
    limits: bool = False


def prepare() -> dict[str, object]:
    """Corrupt the takes."""
    short, other = pruned(walk("07_03")).slice(20, 76), pruned(walk("26_01")).slice(60, 120)
    kick = pruned(hdm05("kickLFront1Reps"))
    squat = pruned(hdm05("squat1Reps"))
    punch = pruned(variety("02_05")).slice(700, 820)
    fine = pruned(walk("07_11", 2)).slice(20, 90)
    arms = _above_the_trunk(kick)
    cases = {
        "walk, 3 deg, spikes": Case(short, _noisy(short, 3.0, 0.15), True, limits=True),
        "squat, clean": Case(squat, squat),
        "walk, gaps": Case(other, _gaps(other, 0.3, "LeftArm", "RightLeg"), True),
        "kick, gaps, no examples": Case(kick, _gaps(kick, 1.0, "lhumerus", "rtibia")),
        "arms, gaps": Case(arms, _gaps(arms, 1.0, "lhumerus", "rradius")),
        "kick, swaps, no examples": Case(kick, _swapped(kick)),
        "punch 120 Hz, spikes": Case(punch, _noisy(punch, 0.3, 0.01)),
        "walk 60 Hz, 1 deg": Case(fine, _noisy(fine, 1.0, 0.0)),
    }
    return {
        "cases": cases,
        "examples": tuple(pruned(walk(name)) for name in EXAMPLES),
        "points": _points(),
    }


def measure(
    cases: dict[str, Case],
    examples: tuple[Motion, ...],
    points: tuple[Tracks, Tracks],
) -> dict[str, float]:
    """Clean them; mean angle error, root error, spikes flagged."""
    bases = learn_filter_bases(examples)
    limits = learn_joint_limits(examples)
    figures = {}
    for name, case in cases.items():
        result = denoise(
            case.given,
            bases if case.examples else None,
            limits=limits if case.limits else None,
        )
        assert isinstance(result.recording, Motion)
        hidden = None if case.given.observed.all() else ~case.given.observed
        figures[f"{name}: deg"] = angle_error(result.recording, case.truth, hidden)
        if hidden is not None:
            figures[f"{name}: confidence"] = _calibration_error(result, case.truth, hidden)
        if "3 deg" in name or "60 Hz" in name:
            figures[f"{name}: root cm"] = root_error(result.recording, case.truth)
        if "spikes" in name:
            off = np.degrees(angle_between(case.given.rotations, case.truth.rotations))
            figures[f"{name}: flags"] = missed_or_false(result.outliers, off > MIN_OUTLIER)
    truth, given = points
    cleaned = denoise(given).recording
    assert isinstance(cleaned, Tracks)
    figures["points, spikes and gaps: mm"] = point_error(cleaned.positions, truth.positions)
    return figures


def _calibration_error(result: Denoised, truth: Motion, hidden: Flags) -> float:
    """Return how far the mean confidence is from the fraction within 5 degrees, %, plus 1."""
    assert isinstance(result.recording, Motion)
    angles = np.degrees(angle_between(result.recording.rotations, truth.rotations))
    is_right = angles[hidden] < 5.0
    return 1.0 + 100.0 * abs(float(result.confidence[hidden].mean() - is_right.mean()))


def _noisy(motion: Motion, jitter: float, spikes: float) -> Motion:
    settings = CorruptionSettings(
        jitter=jitter, spikes=spikes, root_jitter=0.005 * jitter, seed=3
    )
    return corrupt(motion, settings)


def _gaps(motion: Motion, jitter: float, long: str, short: str) -> Motion:
    missing = {long: range(10, 10 + motion.n_frames // 3), short: range(30, 36)}
    return corrupt(motion, CorruptionSettings(jitter=jitter), missing=missing)


def _above_the_trunk(motion: Motion) -> Motion:
    """Return the arms and the head alone: no body, so that no other people's movement helps."""
    skeleton = motion.skeleton
    kept = np.array(skeleton.subtree(skeleton.index("thorax")))
    parents = [int(np.flatnonzero(kept == skeleton.parents[joint])[0]) for joint in kept[1:]]
    above = Skeleton(
        tuple(skeleton.names[joint] for joint in kept), (-1, *parents), skeleton.offsets[kept]
    )
    return Motion(
        above, motion.rotations[:, kept], np.zeros((motion.n_frames, 3)), motion.frame_rate
    )


def _swapped(motion: Motion) -> Motion:
    noisy = corrupt(motion, CorruptionSettings(jitter=1.0, root_jitter=0.005))
    joints = ("lhumerus", "rhumerus", "rfemur")
    return thrown_off(noisy, joints, np.random.default_rng(1))


def _points() -> tuple[Tracks, Tracks]:
    """A walk's joints as points at 60 Hz: 5 mm of noise, spikes of 10 to 30 cm, short gaps."""
    truth = joint_tracks(pruned(walk("10_04", 2)).slice(50, 170))
    rng = np.random.default_rng(5)
    shape = truth.positions.shape
    positions = truth.positions + rng.normal(scale=0.005, size=shape)
    spiky = rng.random(shape[:2]) < 0.01
    positions += spiky[..., None] * rng.uniform(-0.2, 0.2, size=shape)
    for point in range(0, shape[1], 3):
        start = int(rng.integers(5, shape[0] - 10))
        positions[start : start + 4, point] = np.nan
    return truth, truth.with_positions(positions)
