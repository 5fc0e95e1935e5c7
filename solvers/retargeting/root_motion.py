"""The way that a body covers over the ground, apart from the sway of its steps."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ..motion import HumanoidMap, Motion, t_pose_alignment
from ..rotations import IDENTITY, inverse, multiply, rotate, twist_about
from .body import hips_of, hold_gaps

Array = NDArray[np.float64]

UP = np.array([0.0, 0.0, 1.0])
FAR = 4.0
"""Standard deviations beyond which a blur takes nothing in."""
MOST_TILTED = np.radians(60.0)
"""Tilt of the hips beyond which they do not tell where the body faces."""


@dataclass(frozen=True, eq=False)
class GroundPath:
    """Where a body is on the ground and where it faces: what a root bone should do.

    Attributes
    ----------
    positions : shape (n_frames, 3), metres
        Under the hips, smoothed; height 0.
    rotations : shape (n_frames, 4)
        About the vertical; identity where the body faces as in its rest pose.
    """

    positions: Array
    rotations: Array


def ground_path(
    motion: Motion, humanoid: HumanoidMap, smoothing: float = 0.5, *, turn: bool = True
) -> GroundPath:
    """Return the path of a body over the ground.

    Parameters
    ----------
    motion : Motion
    humanoid : HumanoidMap
        Says which joint is the hips.
    smoothing : float, seconds
        Standard deviation of the Gaussian that takes the sway of steps out.
    turn : bool
        Whether the path also turns to where the body faces; it never turns if not.

    Returns
    -------
    GroundPath
        Without gaps: held where the hips are not observed. While the body lies or flips, it
        turns evenly to where the body faces afterwards.

    Raises
    ------
    InvalidMotionError
        The map names no hips.
    """
    hips = hips_of(motion.skeleton, humanoid, "motion's")
    rotations, places = hips_in_world(motion, hips)
    sigma = smoothing * motion.frame_rate
    places = _blurred(places, sigma) * (1.0, 1.0, 0.0)
    if not turn:
        return GroundPath(places, np.tile(IDENTITY, (len(places), 1)))
    rest = t_pose_alignment(motion.skeleton, humanoid)[hips]
    yaw = _blurred(_yaw(multiply(rotations, rest)), sigma) - _yaw(rest[None])
    zero = np.zeros_like(yaw)
    turns = np.stack([np.cos(yaw / 2), zero, zero, np.sin(yaw / 2)], axis=1)
    return GroundPath(places, turns)


def in_place(motion: Motion, humanoid: HumanoidMap, smoothing: float) -> Motion:
    """Return the motion without its travel: the hips only sway about where they began."""
    path = ground_path(motion, humanoid, smoothing, turn=False).positions
    return motion.with_poses(root_positions=motion.root_positions - (path - path[0]))


def on_root_bone(
    motion: Motion, humanoid: HumanoidMap, smoothing: float, *, turn: bool
) -> Motion:
    """Return the motion whose topmost joint turns to where the body faces.

    Nothing from the hips on is elsewhere in the world than before.
    """
    hips = hips_of(motion.skeleton, humanoid, "motion's")
    turns = ground_path(motion, humanoid, smoothing, turn=turn).rotations
    _, places = hips_in_world(motion, hips)
    local = motion.rotations.copy()
    local[:, 0] = turns
    local[:, hips] = multiply(inverse(turns), motion.rotations[:, hips])
    rest = motion.skeleton.rest_positions
    return motion.with_poses(local, places - rotate(turns, rest[hips] - rest[0]))


def hips_in_world(motion: Motion, hips: int) -> tuple[Array, Array]:
    """Return world rotations (n_frames, 4) and positions (n_frames, 3) of the hips, no gaps."""
    rotations = hold_gaps(motion.rotations[:, 0], IDENTITY)
    places = hold_gaps(motion.root_positions, motion.skeleton.rest_positions[0])
    for joint in [hips, *motion.skeleton.ancestors(hips)][-2::-1]:
        places = places + rotate(rotations, motion.skeleton.offsets[joint])
        rotations = multiply(rotations, hold_gaps(motion.rotations[:, joint], IDENTITY))
    return rotations, places


def _yaw(rotations: Array) -> Array:
    """Return by how much bodies are turned about the vertical, radians, without jumps.

    The turn is the twist that is left when the short way from upright to the tilt is taken off
    (swing and twist), so that it does not reverse when the body bends beyond level. Between
    frames that are tilted too far to tell, angles are interpolated.

    Parameters
    ----------
    rotations : shape (n_frames, 4)
        Of the hips, from the canonical T-pose.
    """
    tilt = np.arccos(np.clip(rotate(rotations, UP)[:, 2], -1.0, 1.0))
    known = np.flatnonzero(tilt <= max(MOST_TILTED, tilt.min()))
    twist = twist_about(rotations[known], UP)
    angles = np.unwrap(2.0 * np.arctan2(twist[:, 3], twist[:, 0]))
    return np.interp(np.arange(len(rotations)), known, angles)


def _blurred(values: Array, sigma: float) -> Array:
    """Blur over time; sigma 0 leaves the values as they are.

    Before the first and after the last frame, values go on as they went, mirrored at a point:
    a walk does not slow down where its clip ends.
    """
    width = min(int(FAR * sigma), len(values) - 1)
    if sigma <= 0.0 or not width:
        return values
    before = 2.0 * values[0] - values[width:0:-1]
    after = 2.0 * values[-1] - values[-2 : -width - 2 : -1]
    longer = np.concatenate([before, values, after])
    blurred = gaussian_filter1d(longer, sigma, axis=0, mode="nearest")
    return np.asarray(blurred[width : width + len(values)])
