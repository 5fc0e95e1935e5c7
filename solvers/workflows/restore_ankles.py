"""Restore ankles that were reliably observed at rest before feet were planted."""

import numpy as np
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from ..arrays import Array, Flags
from ..denoising.feet import SIDES, LegJoints, find_legs
from ..motion import Motion, forward_kinematics
from ..motion.skeletons import ReachSettings, reach
from ..rotations import inverse, multiply, rotation_between
from ..signals import smooth_gaussian

MIN_RELIABILITY = 0.6
"""Reliability of an ankle, 0 to 1, above which its observed position is right. Chosen by hand:
x2 fails `test_reliable_ankle_is_planted_near_its_rest_position`."""
MAX_OFFSET_M = 0.03
"""Maximum distance in meters of a planted ankle from its observed rest position. Chosen by
hand: x2 fails `test_reliable_ankle_is_planted_near_its_rest_position`."""
MAX_STILL_SPREAD_M = 0.02
"""Maximum extent in meters of the path of a resting ankle within half a second. Chosen by hand:
x0.5 fails `test_reliable_ankle_is_planted_near_its_rest_position`."""
STILL_WINDOW_S, SMOOTHING_S = 0.5, 0.1
"""Seconds in which a resting ankle hardly moves, and standard deviation in seconds of the
filter of corrections. Chosen by hand: x2 fails
`test_reliable_ankle_is_planted_near_its_rest_position`."""
MIN_CORRECTION_M = 1e-6
"""Meters that are only rounding."""


def restore_ankles(
    planted: Motion, observed: Motion, reliability: Array, contacts: Flags
) -> Motion:
    """Move ankles back that planting has moved away from a reliable rest position.

    Toes stay planted, as closely as the length of the foot allows.

    Parameters
    ----------
    planted, observed : Motion
        After and before feet were planted.
    reliability : shape (n_frames, n_joints), 0 to 1
        NaN: unknown.
    contacts : bool, shape (n_frames, 2), left and right
    """
    before, after = (forward_kinematics(each).positions for each in (observed, planted))
    for leg in find_legs(observed.skeleton):
        ankle = before[:, leg.ankle]
        reliable = np.nan_to_num(reliability[:, leg.ankle]) > MIN_RELIABILITY
        still = contacts[:, SIDES.index(leg.side)] & reliable
        still &= _spread(ankle, STILL_WINDOW_S * observed.frame_rate) < MAX_STILL_SPREAD_M
        correction = _corrections(after[:, leg.ankle] - ankle, still, observed.frame_rate)
        if not correction.any():
            continue
        corrected = np.linalg.norm(correction, axis=-1) > MIN_CORRECTION_M
        target = np.where(corrected[:, None], after[:, leg.ankle] + correction, np.nan)
        planted = reach(planted, leg.chain, target, ReachSettings(softness=0.0))
        planted = _restore_toes(planted, leg, after, corrected)
    return planted


def _corrections(displacement: Array, still: Flags, frame_rate: float) -> Array:
    """Return smooth corrections of planted ankles, shape (n_frames, 3), meters.

    The displacement is low-pass filtered; camera noise in it would make the foot slide.
    """
    displacement = smooth_gaussian(displacement, SMOOTHING_S * frame_rate)
    size = np.linalg.norm(displacement, axis=-1)
    fraction = np.where(still, np.minimum(1.0, MAX_OFFSET_M / np.maximum(size, 1e-9)), 1.0)
    width = SMOOTHING_S * frame_rate
    fraction = minimum_filter1d(fraction, 2 * round(width) + 1, mode="nearest")
    fraction = smooth_gaussian(fraction, width)
    return np.asarray((fraction - 1.0)[:, None] * displacement)


def _spread(ankle: Array, width: float) -> Array:
    """Return the extent of the path of an ankle within a window, shape (n_frames,), meters."""
    size = 2 * round(width / 2) + 1
    highest = maximum_filter1d(ankle, size, axis=0, mode="nearest")
    lowest = minimum_filter1d(ankle, size, axis=0, mode="nearest")
    return np.asarray(np.linalg.norm(highest - lowest, axis=-1))


def _restore_toes(motion: Motion, leg: LegJoints, positions: Array, frames: Flags) -> Motion:
    """Rotate the foot so that its toes return to these positions, in these frames."""
    if leg.toe is None:
        return motion
    poses = forward_kinematics(motion)
    ankle = poses.positions[:, leg.ankle]
    rotation = rotation_between(
        poses.positions[:, leg.toe] - ankle, positions[:, leg.toe] - ankle
    )
    parent = poses.rotations[:, motion.skeleton.parents[leg.ankle]]
    world = multiply(rotation, poses.rotations[:, leg.ankle])
    rotations = motion.rotations.copy()
    rotations[frames, leg.ankle] = multiply(inverse(parent), world)[frames]
    return motion.with_poses(rotations)
