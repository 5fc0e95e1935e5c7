"""Clean captures whose contacts are labeled by a rule of their own.

The label is no truth: it is what heel and ball do at 120 Hz, low-passed at 6 Hz. It measures
how much a detector that gets the joints of a noisy copy loses.
"""

from collections.abc import Iterator
from functools import cache

import numpy as np

from solvers.arrays import Array, Flags
from solvers.feet.legs import find_legs
from solvers.feet.sole import sole_points
from solvers.motion import Motion, forward_kinematics
from solvers.motion.humanoid import SIDES
from solvers.recordings import read_acclaim
from solvers.samples import CorruptionSettings, corrupt

from ..first_press import takes
from ..shared import clips
from .detectors import low_passed

LABEL_HEIGHT_M, LABEL_SPEED = 0.025, 0.25
"""Meters above the height where the point is when it is slow, and meters per second."""
LABEL_PERCENTILE = 10.0
"""Percentile of the heights of slow frames at which a point rests."""
ROOT_JITTER_M = 0.005 / 3.0
"""Meters of noise on the root for each degree on the joints."""
MAX_FRAMES = 480
RATE_HZ = 120.0
HDM05 = (
    "bk_kickLFront1Reps_007", "bk_hopBothLegs1hops_013", "bk_squat1Reps_013",
    "bk_sneak2StepsLStart_004", "dg_depositFloorR_013", "dg_jogLeftCircle4StepsRstart_008",
)  # fmt: skip
WALKS = ("35_01", "05_01")
VARIETY = (("03_03", 300),)
HOPS = (("49_02", 960),)
"""Names and first frames. All are takes that no setting was chosen on."""


@cache
def labeled_clips() -> dict[str, tuple[Motion, Flags]]:
    """Return motions at 120 Hz and their labels, (n_frames, 2)."""
    return {name: (motion, _label(motion)) for name, motion in _clips()}


def at_rate(motion: Motion, label: Flags, rate: float, degrees: float) -> tuple[Motion, Flags]:
    """Return both at a lower rate, the motion with noise on all joints."""
    step = round(RATE_HZ / rate)
    settings = CorruptionSettings(jitter=degrees, root_jitter=degrees * ROOT_JITTER_M)
    return corrupt(clips.every(motion, step), settings), label[::step]


def _clips() -> Iterator[tuple[str, Motion]]:
    for name in HDM05:
        yield name, _cut(read_acclaim(clips.HDM05 / f"HDM_{name}_120.amc"), 0)
    for name in WALKS:
        yield name, _cut(clips.read_cmu(clips.WALKS / f"{name}.bvh", 1), 0)
    for name, first in VARIETY:
        yield name, _cut(takes.read_variety(name), first)
    for name, first in HOPS:
        yield name, _cut(clips.read_cmu(clips.HOPS / f"{name}.bvh", 1), first)


def _cut(motion: Motion, first: int) -> Motion:
    return motion.slice(first, min(first + MAX_FRAMES, motion.n_frames))


def _label(motion: Motion) -> Flags:
    """Return when heel or ball of each foot is low and slow."""
    poses = forward_kinematics(motion)
    labels = np.zeros((motion.n_frames, len(SIDES)), np.bool_)
    for leg in find_legs(motion.skeleton):
        points = sole_points(motion.skeleton, leg)[:2]
        heel_and_ball = np.stack([point.position(poses) for point in points], axis=1)
        labels[:, SIDES.index(leg.side)] = _rests(low_passed(heel_and_ball, motion.frame_rate))
    return labels


def _rests(points: Array) -> Flags:
    slow = np.linalg.norm(np.gradient(points, 1.0 / RATE_HZ, axis=0), axis=-1) < LABEL_SPEED
    floor = [
        np.percentile(points[still, number, 2], LABEL_PERCENTILE) if still.any() else np.inf
        for number, still in enumerate(slow.T)
    ]
    return np.asarray((slow & (points[..., 2] < np.array(floor) + LABEL_HEIGHT_M)).any(axis=1))
