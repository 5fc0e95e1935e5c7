"""Captures of development takes with labels of foot contact, where they are certain.

References
----------
.. [1] Zeni, Richards, Higginson (2008). Two simple methods for determining gait events during
   treadmill and overground walking using kinematic data. Gait & Posture 27(4).
   doi:10.1016/j.gaitpost.2007.07.007
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.ndimage import binary_dilation
from scipy.signal import find_peaks

from solvers.arrays import Array, Flags
from solvers.motion import Motion, find_humanoid_map, forward_kinematics
from solvers.motion.humanoid import foot_points, leg_length
from solvers.motion.humanoid.foot_contacts import HUMAN_LEG_LENGTH_M
from solvers.recordings import read_acclaim
from solvers.signals import smooth_gaussian

from ..benchmarks.contacts.labeled_clips import RATE, label_contacts
from ..benchmarks.shared import clips

MAX_FRAMES = 600
TAKES_OF_A_CLASS = 4
OTHERS = (
    "depositFloorR", "elbowToKnee1RepsLelbowStart", "grabHighR", "kickLFront1Reps",
    "rotateArmsBothBackward1Reps", "sneak2StepsLStart", "squat1Reps", "throwBasketball",
)  # fmt: skip
"""Classes of HDM05 with contacts that last."""
UNSURE_S = 0.1
"""Seconds on either side of a change of the rule's label that are not used."""
UNSURE_LANDING_S = 0.06
"""Seconds around a landing of [1]_ that are not used: the ankle swings back before it lands."""
MIN_WALKING_SPEED = 0.5
MIN_SWING_M, MIN_STRIDE_S = 0.2, 0.4


class LabeledFeet(NamedTuple):
    """Ankles and toes (n_frames, 2, 2, 3) for legs of 0.9 m, contacts, and where these count."""

    positions: Array
    contacts: Flags
    known: Flags
    rate: float


def labeled_walks() -> Iterator[LabeledFeet]:
    """Return walks of CMU's development subjects, labeled by [1]_."""
    for name in clips.development(True):
        motion = _cut(clips.read_cmu(clips.WALKS / f"{name}.bvh", 1))
        positions, size = _feet(motion)
        yield LabeledFeet(positions / size, *_gait_events(motion, positions), RATE)


def labeled_others() -> Iterator[LabeledFeet]:
    """Return takes of HDM05's development actor, labeled by the rule of the benchmark."""
    for name in OTHERS:
        for actor in sorted(clips.DEV_ACTORS):
            paths = sorted(clips.HDM05.glob(f"HDM_{actor}_{name}_*_120.amc"))
            for path in paths[:TAKES_OF_A_CLASS]:
                motion = _cut(read_acclaim(path))
                label = label_contacts(motion)
                changes = np.diff(label, axis=0, prepend=label[:1])
                width = 2 * round(UNSURE_S * RATE) + 1
                known = ~binary_dilation(changes, np.ones((width, 1)))
                positions, size = _feet(motion)
                yield LabeledFeet(positions / size, label, known, RATE)


def _feet(motion: Motion) -> tuple[Array, float]:
    """Return ankles and toes in meters, and the length of the legs over 0.9 m."""
    humanoid = find_humanoid_map(motion.skeleton)
    feet = foot_points(motion.skeleton, humanoid)
    size = leg_length(motion.skeleton, humanoid) / HUMAN_LEG_LENGTH_M
    return forward_kinematics(motion).positions[:, feet], size


def _gait_events(motion: Motion, positions: Array) -> tuple[Flags, Flags]:
    """Return contacts and where they are known: between the first and the last event.

    A foot lands where its ankle is farthest in front of the hips, and leaves where its toes are
    farthest behind them.
    """
    root = motion.root_positions[:, :2]
    velocity = np.gradient(smooth_gaussian(root, 0.3 * RATE), 1.0 / RATE, axis=0)
    speed = np.linalg.norm(velocity, axis=1, keepdims=True)
    ahead = velocity / np.maximum(speed, 1e-9)
    contacts = np.zeros((len(positions), 2), np.bool_)
    known = np.zeros_like(contacts)
    for foot in range(2):
        from_hips = positions[:, foot, :, :2] - root[:, None]
        relative = np.einsum("fpi,fi->fp", from_hips, ahead)
        options = {"prominence": MIN_SWING_M, "distance": MIN_STRIDE_S * RATE}
        landings, _ = find_peaks(relative[:, 0], **options)
        lifts, _ = find_peaks(-relative[:, 1], **options)
        events = sorted([(frame, True) for frame in landings] + [(frame, False) for frame in lifts])
        for (start, lands), (stop, lands_next) in zip(events, events[1:], strict=False):
            if lands != lands_next:
                contacts[start:stop, foot] = lands
                known[start:stop, foot] = True
        for landing in landings:
            width = round(UNSURE_LANDING_S * RATE)
            known[max(landing - width, 0) : landing + width, foot] = False
    return contacts, known & (speed > MIN_WALKING_SPEED)


def _cut(motion: Motion) -> Motion:
    return motion.slice(0, min(MAX_FRAMES, motion.n_frames))
