"""Build the target of a simulation: the take without gaps, smoothed, as a spline."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import InvalidMotionError
from ..motion import Motion
from ..rotations import inverse, multiply, normalize, slerp, unroll
from ..signals import fill_gaps, fill_rotation_gaps, smooth_to_the_ends

SPLINE_VARIANCE = 1.0 / 3.0
"""Variance of the uniform cubic B-spline as a filter, in squared frames. By definition: it is
four boxes of one frame, convolved, each with a variance of 1/12."""


class BodyStates(NamedTuple):
    """States of the body at several times, in MuJoCo's coordinates.

    The base comes first: its position and linear velocity, in the world. All rotations follow,
    w x y z, local except for the base, with angular velocities in the joint's own frame.
    """

    coordinates: Array
    velocities: Array
    accelerations: Array


@dataclass(frozen=True, eq=False)
class TargetCurve:
    """Control points of a uniform cubic B-spline, one for each frame and one beyond each end.

    Attributes
    ----------
    controls : shape (n_frames + 2, 3 + 4 n_joints)
    dt : float, seconds between frames
    """

    controls: Array
    dt: float

    @property
    def n_frames(self) -> int:
        """Number of frames."""
        return len(self.controls) - 2

    def at_frames(self) -> Array:
        """Return the coordinates at all frames, as in `BodyStates.coordinates`."""
        value = (self.controls[:-2] + 4 * self.controls[1:-1] + self.controls[2:]) / 6
        rotations = normalize(value[:, 3:].reshape(len(value), -1, 4))
        return np.hstack([value[:, :3], rotations.reshape(len(value), -1)])

    def between(self, frame: int, n_steps: int) -> BodyStates:
        """Return the states at `frame` and at the further steps before the next frame."""
        u = np.arange(n_steps)[:, None] / n_steps
        near = self.controls[frame : frame + 4]
        if len(near) < 4:
            near = np.concatenate([near, near[-1:]])
        v = 1 - u
        value = np.hstack([v**3, 4 - 6 * u**2 + 3 * u**3, 4 - 6 * v**2 + 3 * v**3, u**3]) / 6
        first_derivative = np.hstack([-(v**2), 3 * u**2 - 4 * u, 4 * v - 3 * v**2, u**2]) / 2
        second_derivative = np.hstack([v, 3 * u - 2, 3 * v - 2, u])
        return _states_from_spline(
            value @ near,
            first_derivative @ near / self.dt,
            second_derivative @ near / self.dt**2,
        )


def _states_from_spline(
    value: Array, first_derivative: Array, second_derivative: Array
) -> BodyStates:
    """Convert curves of quaternion components to unit quaternions and angular velocities.

    For p of any length, the angular velocity in the rotating frame is 2 Im(p* p') / |p|^2.
    """
    n = len(value)
    p, dp, ddp = (
        x[:, 3:].reshape(n, -1, 4) for x in (value, first_derivative, second_derivative)
    )
    squares = (p * p).sum(axis=-1, keepdims=True)
    angular_velocity = 2 * multiply(inverse(p), dp)[..., 1:] / squares
    angular_acceleration = 2 * multiply(inverse(p), ddp)[..., 1:] / squares
    angular_acceleration -= (
        2 * (p * dp).sum(axis=-1, keepdims=True) / squares * angular_velocity
    )
    return BodyStates(
        np.hstack([value[:, :3], (p / np.sqrt(squares)).reshape(n, -1)]),
        np.hstack([first_derivative[:, :3], angular_velocity.reshape(n, -1)]),
        np.hstack([second_derivative[:, :3], angular_acceleration.reshape(n, -1)]),
    )


def smooth_target(
    coordinates: Array, rotations: Array, frame_rate: float, smoothing: float
) -> TargetCurve:
    """Return the target curve of base and joints, smoothed by a Gaussian.

    Parameters
    ----------
    coordinates : shape (n_frames, 3), meters
        Positions of the base.
    rotations : shape (n_frames, n_joints, 4)
        Without gaps; the base's are in the world.
    frame_rate : float, hertz
    smoothing : float, seconds
        Standard deviation in total: the spline alone smooths by 0.58 of a frame, and the
        Gaussian adds the rest.
    """
    n_frames = len(coordinates)
    channels = np.hstack([coordinates, unroll(rotations).reshape(n_frames, -1)])
    variance = (smoothing * frame_rate) ** 2 - SPLINE_VARIANCE
    smooth = smooth_to_the_ends(channels, np.sqrt(max(variance, 0.0)))
    if n_frames == 1:
        return TargetCurve(np.repeat(smooth, 3, axis=0), 1.0 / frame_rate)
    first, last = 2 * smooth[:1] - smooth[1:2], 2 * smooth[-1:] - smooth[-2:-1]
    return TargetCurve(np.concatenate([first, smooth, last]), 1.0 / frame_rate)


def blend_motions(
    motion: Motion, other: Motion, joints: Sequence[int], weights: Array
) -> Motion:
    """Blend a motion with another by a weight for each frame, 0 to 1, shape (n_frames,).

    Only the root's position and the rotations of these joints change. Weight 1 gives the
    other's bits, and weight 0 those of the motion.
    """
    rotations = motion.rotations.copy()
    first, rest = rotations[:, list(joints)], other.rotations[:, list(joints)]
    rotated = slerp(first, rest, np.broadcast_to(weights[:, None], first.shape[:2]))
    rotated = np.where(weights[:, None, None] == 0.0, first, rotated)
    rotations[:, list(joints)] = np.where(weights[:, None, None] == 1.0, rest, rotated)
    weight = weights[:, None]
    roots = (1 - weight) * motion.root_positions + weight * other.root_positions
    return motion.with_poses(rotations, roots)


def fade_around(frames: NDArray[np.bool_], ease: float) -> Array:
    """Return weights, (n_frames,), 0 at these frames and rising to 1 within `ease` frames."""
    # A frame beyond each end, too far to matter, so that there is one to measure to.
    n_padding = int(ease) + 2
    is_clear = np.pad(~frames, n_padding, constant_values=True)
    is_clear[[0, -1]] = False
    distances = scipy.ndimage.distance_transform_edt(is_clear)[n_padding:-n_padding]
    return np.asarray(np.minimum(1.0, distances / ease))


def fill_motion_gaps(motion: Motion) -> Motion:
    """Return the motion without gaps: interpolated across them, constant at the take's ends.

    A joint that is never observed stays in its rest pose.

    Raises
    ------
    InvalidMotionError
        The root's position is never observed.
    """
    if motion.observed.all():
        return motion
    if not np.isfinite(motion.root_positions).all(axis=-1).any():
        raise InvalidMotionError(
            "The position of the root is never observed, so there is nothing to simulate."
        )
    rotations = fill_rotation_gaps(motion.rotations)
    return motion.with_poses(rotations, fill_gaps(motion.root_positions))
