"""Separate the travel of a body over the ground from the sway of its steps."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..motion import HumanoidMap, Motion, t_pose_alignment
from ..rotations import IDENTITY, inverse, multiply, rotate, twist_about
from ..signals import smooth_to_the_ends
from .body import MOTION, hips_of, hold_gaps

UP = np.array([0.0, 0.0, 1.0])
MAX_TILT_RAD = np.radians(60.0)
"""Tilt of the hips above which they do not define the facing direction. It guards actors who
get up: the root would turn in one frame
(`test_root_rotates_smoothly_while_an_actor_gets_up`)."""


@dataclass(frozen=True, eq=False)
class GroundPath:
    """Position and facing direction of a body on the ground: the motion of a root bone.

    Attributes
    ----------
    positions : shape (n_frames, 3), meters
        Below the hips, smoothed; height 0.
    rotations : shape (n_frames, 4)
        About the vertical; identity for the facing direction of the rest pose.
    """

    positions: Array
    rotations: Array


def ground_path(
    motion: Motion,
    humanoid: HumanoidMap,
    smoothing: float = 0.5,
    *,
    follow_heading: bool = True,
) -> GroundPath:
    """Return the path of a body over the ground.

    Parameters
    ----------
    motion : Motion
    humanoid : HumanoidMap
        Must have the role hips.
    smoothing : float, seconds
        Standard deviation of the Gaussian that removes the sway of steps.
    follow_heading : bool
        Whether the path also rotates to the facing direction.

    Returns
    -------
    GroundPath
        Without gaps: constant where the hips are missing. While the body lies or flips, the
        facing direction is interpolated.

    Raises
    ------
    InvalidMotionError
        The map has no hips.
    """
    hips = hips_of(motion.skeleton, humanoid, MOTION)
    rotations, positions = hips_in_world(motion, hips)
    sigma = smoothing * motion.frame_rate
    positions = smooth_to_the_ends(positions, sigma) * (1.0, 1.0, 0.0)
    if not follow_heading:
        return GroundPath(positions, np.tile(IDENTITY, (len(positions), 1)))
    rest = t_pose_alignment(motion.skeleton, humanoid)[hips]
    yaw = smooth_to_the_ends(_yaw(multiply(rotations, rest)), sigma) - _yaw(rest[None])
    zero = np.zeros_like(yaw)
    headings = np.stack([np.cos(yaw / 2), zero, zero, np.sin(yaw / 2)], axis=1)
    return GroundPath(positions, headings)


def in_place(motion: Motion, humanoid: HumanoidMap, smoothing: float) -> Motion:
    """Return the motion without its travel: the hips only sway about their first position."""
    path = ground_path(motion, humanoid, smoothing, follow_heading=False).positions
    return motion.with_poses(root_positions=motion.root_positions - (path - path[0]))


def on_root_bone(
    motion: Motion, humanoid: HumanoidMap, smoothing: float, *, follow_heading: bool
) -> Motion:
    """Return the motion with a root that rotates to the facing direction.

    The world poses of the hips and their descendants are unchanged.
    """
    hips = hips_of(motion.skeleton, humanoid, MOTION)
    headings = ground_path(motion, humanoid, smoothing, follow_heading=follow_heading).rotations
    _, positions = hips_in_world(motion, hips)
    local = motion.rotations.copy()
    local[:, 0] = headings
    local[:, hips] = multiply(inverse(headings), motion.rotations[:, hips])
    rest = motion.skeleton.rest_positions
    return motion.with_poses(local, positions - rotate(headings, rest[hips] - rest[0]))


def hips_in_world(motion: Motion, hips: int) -> tuple[Array, Array]:
    """Return world rotations (n_frames, 4) and positions (n_frames, 3) of the hips, no gaps."""
    rotations = hold_gaps(motion.rotations[:, 0], IDENTITY)
    positions = hold_gaps(motion.root_positions, motion.skeleton.rest_positions[0])
    for joint in [hips, *motion.skeleton.ancestors(hips)][-2::-1]:
        positions = positions + rotate(rotations, motion.skeleton.offsets[joint])
        rotations = multiply(rotations, hold_gaps(motion.rotations[:, joint], IDENTITY))
    return rotations, positions


def _yaw(rotations: Array) -> Array:
    """Return the yaw of rotations about the vertical, radians, without jumps.

    It is the twist of the swing-twist decomposition about the vertical, so that it does not
    reverse when the body bends beyond horizontal. Frames with a larger tilt are interpolated.

    Parameters
    ----------
    rotations : shape (n_frames, 4)
        World rotations of the hips, from the canonical T-pose.
    """
    tilt = np.arccos(np.clip(rotate(rotations, UP)[:, 2], -1.0, 1.0))
    upright = np.flatnonzero(tilt <= max(MAX_TILT_RAD, tilt.min()))
    twist = twist_about(rotations[upright], UP)
    angles = np.unwrap(2.0 * np.arctan2(twist[:, 3].copy(), twist[:, 0].copy()))
    return np.interp(np.arange(len(rotations)), upright, angles)
