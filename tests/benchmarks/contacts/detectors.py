"""Detectors of foot contact: ours, thresholds, and the rules of two papers.

Each gets the ankle and the toes of both feet in meters, as `contacts_of_points` does.

References
----------
.. [1] Holden, Saito, Komura (2016). A deep learning framework for character motion synthesis
   and editing. ACM Transactions on Graphics 35(4). Their code labels a joint of the foot at
   60 Hz if its squared displacement is below 0.05 and its height below 3 (ankle) or 2 (toes),
   in units of the CMU skeleton in BVH, 5.64 cm.
.. [2] Guo et al. (2022). Generating diverse and natural 3D human motions from text. CVPR. Their
   code labels a joint at 20 Hz if its squared displacement is below 0.002 square meters.
.. [3] Winter (2009). Biomechanics and Motor Control of Human Movement, chapter 3: positions of
   walking are low-passed at 6 Hz.
"""

from collections.abc import Callable

import numpy as np

from solvers.arrays import Array, Flags
from solvers.feet.legs import find_legs
from solvers.feet.standing_feet import detect_standing_feet
from solvers.motion import Motion, find_humanoid_map, forward_kinematics
from solvers.motion.humanoid import contacts_of_points, foot_points, leg_length
from solvers.motion.humanoid.foot_contacts import HUMAN_LEG_LENGTH_M

from ..peers.smoothers import butterworth
from ..shared.clips import CMU_METERS

OURS = "ours"
HEIGHT_M, SPEED = 0.05, 0.3
"""Meters and meters per second: the thresholds of ours, without all else."""
LOW_PASS_HZ = 6.0
HOLDEN_HEIGHTS_M = CMU_METERS * np.array([3.0, 2.0])
HOLDEN_SPEED = CMU_METERS * np.sqrt(0.05) * 60.0
GUO_SPEED = np.sqrt(0.002) * 20.0

PointDetector = Callable[[Array, float, float], Flags]
"""From positions (n_frames, 2 feet, ankle and toes, 3), frame rate and size to contacts."""
MotionDetector = Callable[[Motion], Flags]


def by_thresholds(positions: Array, frame_rate: float, size: float = 1.0) -> Flags:
    """Return when the ankle or the toes are slow and hardly higher than ever in the clip."""
    heights = positions[..., 2] - np.nanmin(positions[..., 2], axis=(0, 1))
    slow = _speeds(positions, frame_rate) < size * SPEED
    return np.asarray(((heights < size * HEIGHT_M) & slow).any(axis=-1))


def by_low_passed_thresholds(positions: Array, frame_rate: float, size: float = 1.0) -> Flags:
    """Return the same of low-passed feet."""
    return by_thresholds(low_passed(positions, frame_rate), frame_rate, size)


def by_holden(positions: Array, frame_rate: float, size: float = 1.0) -> Flags:
    """Return contacts by the rule of [1]_; the floor is below the lowest joint of the clip."""
    heights = positions[..., 2] - np.nanmin(positions[..., 2])
    slow = _speeds(positions, frame_rate) < size * HOLDEN_SPEED
    return np.asarray(((heights < size * HOLDEN_HEIGHTS_M) & slow).any(axis=-1))


def by_guo(positions: Array, frame_rate: float, size: float = 1.0) -> Flags:
    """Return contacts by the rule of [2]_, which does not look at heights."""
    return np.asarray((_speeds(positions, frame_rate) < size * GUO_SPEED).any(axis=-1))


POINT_DETECTORS: dict[str, PointDetector] = {
    OURS: contacts_of_points,
    "height and speed": by_thresholds,
    "the same, low-passed": by_low_passed_thresholds,
    "Holden et al. 2016": by_holden,
    "Guo et al. 2022": by_guo,
}


def standing_feet(motion: Motion) -> Flags:
    """Return the contacts that planting starts from."""
    humanoid = find_humanoid_map(motion.skeleton)
    return detect_standing_feet(motion, humanoid, find_legs(motion.skeleton, humanoid))


def _of_motions(detector: PointDetector) -> MotionDetector:
    def detect(motion: Motion) -> Flags:
        humanoid = find_humanoid_map(motion.skeleton)
        feet = foot_points(motion.skeleton, humanoid)
        size = leg_length(motion.skeleton, humanoid) / HUMAN_LEG_LENGTH_M
        return detector(forward_kinematics(motion).positions[:, feet], motion.frame_rate, size)

    return detect


MOTION_DETECTORS: dict[str, MotionDetector] = {
    name: _of_motions(detector) for name, detector in POINT_DETECTORS.items()
} | {OURS: standing_feet}


def low_passed(positions: Array, frame_rate: float) -> Array:
    """Return positions without what is faster than 6 Hz [3]_; gaps stay gaps."""
    observed = np.isfinite(positions)
    frames = np.arange(len(positions))
    columns = positions.reshape(len(positions), -1).copy()
    for column, is_observed in zip(
        columns.T, observed.reshape(len(positions), -1).T, strict=True
    ):
        if is_observed.any():
            column[:] = np.interp(frames, frames[is_observed], column[is_observed])
    smooth = butterworth(np.nan_to_num(columns), frame_rate, LOW_PASS_HZ)
    return np.where(observed, smooth.reshape(positions.shape), np.nan)


def _speeds(positions: Array, frame_rate: float) -> Array:
    """Return the speed of each joint since the frame before."""
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=-1) * frame_rate
    return np.concatenate([steps[:1], steps])
