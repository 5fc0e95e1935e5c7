"""Ankles that were seen to stand still stay there, whatever their toes do."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d, maximum_filter1d, minimum_filter1d

from ..denoising.feet import SIDES, Leg, find_legs
from ..motion import Motion, forward_kinematics
from ..motion.skeletons import ReachSettings, reach
from ..rotations import inverse, multiply, rotation_between

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

TRUSTED = 0.6
FARTHEST = 0.03
"""Metres. How far from where it was seen to be a still ankle may be planted."""
STILL = 0.02
"""Metres within which a still ankle keeps for half a second."""
LONG, EASE = 0.5, 0.1
"""Seconds."""
LEAST = 1e-6
"""Metres."""


def keep_ankles(planted: Motion, seen: Motion, reliability: Array, contacts: Flags) -> Motion:
    """Bring ankles back that planting has moved away from where they were trusted and still.

    Toes stay where they were planted, as nearly as the length of the foot allows.

    Parameters
    ----------
    planted, seen : Motion
        After and before feet were planted.
    reliability : shape (n_frames, n_joints), 0 to 1
        NaN: not known.
    contacts : bool, shape (n_frames, 2), left and right
    """
    before, after = (forward_kinematics(each).positions for each in (seen, planted))
    for leg in find_legs(seen.skeleton):
        ankle = before[:, leg.ankle]
        trusted = np.nan_to_num(reliability[:, leg.ankle]) > TRUSTED
        still = contacts[:, SIDES.index(leg.side)] & trusted
        still &= _spread(ankle, LONG * seen.frame_rate) < STILL
        back = _way_back(after[:, leg.ankle] - ankle, still, seen.frame_rate)
        if not back.any():
            continue
        kept = np.linalg.norm(back, axis=-1) > LEAST
        target = np.where(kept[:, None], after[:, leg.ankle] + back, np.nan)
        planted = reach(planted, leg.chain, target, ReachSettings(softness=0.0))
        planted = _toes_at(planted, leg, after, kept)
    return planted


def _way_back(moved: Array, still: Flags, frame_rate: float) -> Array:
    """Return the ways by which planted ankles come back, steadily, shape (n_frames, 3).

    What a camera's noise adds to the way is left out, or the foot would slide by it.
    """
    moved = gaussian_filter1d(moved, EASE * frame_rate, axis=0, mode="nearest")
    size = np.linalg.norm(moved, axis=-1)
    share = np.where(still, np.minimum(1.0, FARTHEST / np.maximum(size, 1e-9)), 1.0)
    width = EASE * frame_rate
    share = minimum_filter1d(share, 2 * round(width) + 1, mode="nearest")
    share = gaussian_filter1d(share, width, mode="nearest")
    return np.asarray((share - 1.0)[:, None] * moved)


def _spread(ankle: Array, width: float) -> Array:
    """Return how far an ankle gets about within so many frames, shape (n_frames,), metres."""
    size = 2 * round(width / 2) + 1
    most = maximum_filter1d(ankle, size, axis=0, mode="nearest")
    least = minimum_filter1d(ankle, size, axis=0, mode="nearest")
    return np.asarray(np.linalg.norm(most - least, axis=-1))


def _toes_at(motion: Motion, leg: Leg, places: Array, frames: Flags) -> Motion:
    """Turn the foot to where its toes were, in these frames."""
    if leg.toe is None:
        return motion
    poses = forward_kinematics(motion)
    ankle = poses.positions[:, leg.ankle]
    turn = rotation_between(poses.positions[:, leg.toe] - ankle, places[:, leg.toe] - ankle)
    above = poses.rotations[:, motion.skeleton.parents[leg.ankle]]
    world = multiply(turn, poses.rotations[:, leg.ankle])
    rotations = motion.rotations.copy()
    rotations[frames, leg.ankle] = multiply(inverse(above), world)[frames]
    return motion.with_poses(rotations)
