"""The way that a body covers over the ground, apart from the sway of its steps."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ..motion import HumanoidMap, Motion, t_pose_alignment
from ..motion.rotations import IDENTITY, inverse, multiply, rotate
from .body import held, hips_of

Array = NDArray[np.float64]

FORWARD = np.array([0.0, -1.0, 0.0])
UPRIGHT = 0.1
"""Length, over the ground, of the direction that hips face, below which they face nowhere."""


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
        Without gaps: held where the hips are not observed.

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
    ahead = rotate(t_pose_alignment(motion.skeleton, humanoid)[hips], FORWARD)
    ahead = ahead * (1.0, 1.0, 0.0)
    faces = rotate(rotations, ahead)[:, :2]
    unclear = np.linalg.norm(faces, axis=1) < UPRIGHT
    faces = _blurred(held(np.where(unclear[:, None], np.nan, faces), ahead[:2]), sigma)
    yaw = np.arctan2(faces[:, 1], faces[:, 0]) - np.arctan2(ahead[1], ahead[0])
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
    rotations = held(motion.rotations[:, 0], IDENTITY)
    places = held(motion.root_positions, motion.skeleton.rest_positions[0])
    for joint in [hips, *motion.skeleton.ancestors(hips)][-2::-1]:
        places = places + rotate(rotations, motion.skeleton.offsets[joint])
        rotations = multiply(rotations, held(motion.rotations[:, joint], IDENTITY))
    return rotations, places


def _blurred(values: Array, sigma: float) -> Array:
    """Blur over time; sigma 0 leaves the values as they are."""
    if sigma <= 0.0:
        return values
    return np.asarray(gaussian_filter1d(values, sigma, axis=0, mode="nearest"))
