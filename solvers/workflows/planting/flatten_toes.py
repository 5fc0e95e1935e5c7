"""Flatten the toes of standing feet where the camera missed them."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...feet import LegJoints, find_legs
from ...motion import Motion, WorldPoses, forward_kinematics
from ...motion.humanoid import SIDES
from ...rotations import IDENTITY, inverse, multiply, rotate, rotation_between, slerp
from ...signals import smooth_gaussian

MAX_CORRECTED_RELIABILITY, MAX_MISSING_RELIABILITY = 0.8, 0.5
"""Reliability below which toes are flattened partly, and below which completely. Joints that a
tracker inferred have at most the second. Chosen by hand: x0.5 fails
`test_resting_ankle_stays_when_its_toe_is_missing`, x2
`test_reliable_feet_are_planted_as_without_reliability`."""
MAX_TOE_HEIGHT_M = 0.03
"""Height in meters of the toes above the ankle at which a standing foot is flattened fully,
however reliable they are. It guards toes that a tracker puts on the instep
(`test_toe_that_points_up_is_flattened`)."""
DEFAULT_DROP = 0.35
"""Height of the ankle above the toes in foot lengths, a ratio, if no frame measures it.
Measured: in still frames markers of UI-PRMD have 0.12 to 0.29, and half of the feet that a
Kinect v2 tracked in IRDS and KIMORE 0.29 to 0.68."""
MAX_DROP = 0.7
"""Largest such height that a frame may measure, a ratio: twice the default. It guards takes
whose feet hang, which measure a foot on tiptoe."""
MIN_STANDING_FRAMES = 10
"""Minimum number of reliable standing frames to measure the pose of a foot. Chosen by hand: 0.3
s at 30 Hz, so that a few wrong frames are not a majority."""
BLEND_S, HEADING_SMOOTHING_S = 0.05, 0.5
"""Seconds over which the correction begins and ends, and over which the heading of the shin is
smoothed. Chosen by hand: 1.5 frames at 30 Hz, so that toes do not jump, and 15 frames, in which
a standing foot does not turn."""
MIN_LEVEL_FRACTION = 0.2
"""Minimum horizontal fraction of the length of a foot that defines a heading. Chosen by hand:
a foot below it hangs within 12 degrees of the vertical (3 cm of 15), and does not stand."""


def flatten_toes(motion: Motion, reliability: Array, contacts: NDArray[np.bool_]) -> Motion:
    """Rotate standing feet flat where their toes are missing or above the ankle.

    The heading follows the shin, with the median offset of observed toes or that of the rest
    pose. The height of the ankle is the median over observed standing frames.

    Parameters
    ----------
    motion : Motion
    reliability : shape (n_frames, n_joints), 0 to 1
        NaN: reliable.
    contacts : bool, shape (n_frames, 2), left and right
        Frames in which each foot stands.
    """
    poses = forward_kinematics(motion)
    rotations = motion.rotations.copy()
    for leg in find_legs(motion.skeleton):
        standing = contacts[:, SIDES.index(leg.side)]
        if leg.toe is None or not standing.any():
            continue
        foot = poses.positions[:, leg.toe] - poses.positions[:, leg.ankle]
        toe_reliability = np.nan_to_num(reliability[:, leg.toe], nan=1.0)
        weight = np.clip(
            (MAX_CORRECTED_RELIABILITY - toe_reliability)
            / (MAX_CORRECTED_RELIABILITY - MAX_MISSING_RELIABILITY),
            0.0,
            1.0,
        )
        weight = np.maximum(weight, np.clip(foot[:, 2] / MAX_TOE_HEIGHT_M, 0.0, 1.0))
        target = _flat_foot(motion, poses, leg, foot, standing & (weight == 0.0))
        has_target = np.isfinite(target).all(axis=-1)
        blend = np.where(has_target, weight * standing, 0.0)
        blend = smooth_gaussian(blend, BLEND_S * motion.frame_rate)
        swing = rotation_between(foot, np.where(has_target[:, None], target, foot))
        rotation = slerp(np.broadcast_to(IDENTITY, swing.shape), swing, blend)
        parent = poses.rotations[:, motion.skeleton.parents[leg.ankle]]
        world = multiply(rotation, poses.rotations[:, leg.ankle])
        changed = multiply(inverse(parent), world)
        rotations[:, leg.ankle] = np.where(
            blend[:, None] > 0.0, changed, rotations[:, leg.ankle]
        )
    return motion.with_poses(rotations)


def _flat_foot(
    motion: Motion, poses: WorldPoses, leg: LegJoints, foot: Array, reliable: NDArray[np.bool_]
) -> Array:
    """Return the vector from ankle to toes of a flat foot; NaN without a heading."""
    shin = poses.rotations[:, leg.knee]
    rest = motion.skeleton.rest_positions
    length = float(np.linalg.norm(rest[leg.toe] - rest[leg.ankle]))
    local, drop = rest[leg.toe] - rest[leg.ankle], DEFAULT_DROP * length
    if reliable.sum() >= MIN_STANDING_FRAMES:
        local = np.median(rotate(inverse(shin[reliable]), foot[reliable]), axis=0)
        drop = float(np.clip(np.median(-foot[reliable, 2]), 0.0, MAX_DROP * length))
    heading = rotate(shin, local)[:, :2]
    heading = smooth_gaussian(heading, HEADING_SMOOTHING_S * motion.frame_rate)
    size = np.linalg.norm(heading, axis=-1, keepdims=True)
    heading = np.where(
        size > MIN_LEVEL_FRACTION * length, heading / np.maximum(size, 1e-9), np.nan
    )
    level = np.sqrt(length**2 - drop**2)
    return np.concatenate([level * heading, np.full((len(foot), 1), -drop)], axis=-1)
