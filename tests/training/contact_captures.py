"""Captured walks with labels of foot contact.

References
----------
.. [1] Zeni, Richards, Higginson (2008). Two simple methods for determining gait events during
   treadmill and overground walking using kinematic data. Gait & Posture 27(4).
   doi:10.1016/j.gaitpost.2007.07.007
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.signal import find_peaks

from solvers.arrays import Array, Flags
from solvers.motion import Motion, find_humanoid_map, forward_kinematics
from solvers.motion.humanoid import foot_points, leg_length
from solvers.motion.humanoid.foot_contacts import HUMAN_LEG_LENGTH_M
from solvers.signals import smooth_gaussian

from ..benchmarks.shared import clips

RATE_HZ = 120.0
MAX_FRAMES = 600
UNLABELED_LANDING_S = 0.06
"""Seconds around a landing of [1]_ that are not used: the ankle swings back before it lands."""
MIN_WALKING_SPEED = 0.5
MIN_SWING_M, MIN_STRIDE_S = 0.2, 0.4


class LabeledFeet(NamedTuple):
    """Ankles and toes (n_frames, 2, 2, 3) for legs of 0.9 m, contacts, where these count."""

    positions: Array
    contacts: Flags
    known: Flags


def labeled_walks() -> Iterator[LabeledFeet]:
    """Return walks of CMU's development subjects, labeled by [1]_."""
    for name in clips.development(True):
        motion = _cut(clips.read_cmu(clips.WALKS / f"{name}.bvh", 1))
        positions, size = _feet(motion)
        yield LabeledFeet(positions / size, *_gait_events(motion, positions))


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
    velocity = np.gradient(smooth_gaussian(root, 0.3 * RATE_HZ), 1.0 / RATE_HZ, axis=0)
    speed = np.linalg.norm(velocity, axis=1, keepdims=True)
    ahead = velocity / np.maximum(speed, 1e-9)
    contacts = np.zeros((len(positions), 2), np.bool_)
    known = np.zeros_like(contacts)
    for foot in range(2):
        from_hips = positions[:, foot, :, :2] - root[:, None]
        relative = np.einsum("fpi,fi->fp", from_hips, ahead)
        options = {"prominence": MIN_SWING_M, "distance": MIN_STRIDE_S * RATE_HZ}
        landings, _ = find_peaks(relative[:, 0], **options)
        lifts, _ = find_peaks(-relative[:, 1], **options)
        events = sorted(
            [(frame, True) for frame in landings] + [(frame, False) for frame in lifts]
        )
        for (start, lands), (stop, lands_next) in pairwise(events):
            if lands != lands_next:
                contacts[start:stop, foot] = lands
                known[start:stop, foot] = True
        for landing in landings:
            width = round(UNLABELED_LANDING_S * RATE_HZ)
            known[max(landing - width, 0) : landing + width, foot] = False
    return contacts, known & (speed > MIN_WALKING_SPEED)


def _cut(motion: Motion) -> Motion:
    return motion.slice(0, min(MAX_FRAMES, motion.n_frames))
