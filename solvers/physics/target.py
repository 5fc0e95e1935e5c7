"""What a simulated body is to follow: the take without gaps, calmed, as a smooth curve."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, gaussian_filter1d

from ..errors import InvalidMotionError
from ..motion import Motion
from ..rotations import inverse, multiply, normalize, slerp, unroll
from ..signals import bridged, bridged_rotations

Array = NDArray[np.float64]
SPLINE_VARIANCE = 1.0 / 3.0
"""Of the uniform cubic B-spline as a filter, in squares of its step."""

WIDEST = 4.0
"""Standard deviations after which a Gaussian is cut off."""


class States(NamedTuple):
    """States of the body at some moments, in MuJoCo's coordinates.

    The base comes first: its place and how fast it moves, in the world. Then there are all
    rotations w x y z, local but for the base, and how fast they turn, in the joint's own frame.
    """

    places: Array
    velocities: Array
    accelerations: Array


@dataclass(frozen=True, eq=False)
class Target:
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
        """Return the places at all frames, as in `States.places`."""
        value = (self.controls[:-2] + 4 * self.controls[1:-1] + self.controls[2:]) / 6
        turns = normalize(value[:, 3:].reshape(len(value), -1, 4))
        return np.hstack([value[:, :3], turns.reshape(len(value), -1)])

    def between(self, frame: int, n_steps: int) -> States:
        """Return the states at `frame` and at the further steps before the next frame."""
        u = np.arange(n_steps)[:, None] / n_steps
        near = self.controls[frame : frame + 4]
        if len(near) < 4:
            near = np.concatenate([near, near[-1:]])
        v = 1 - u
        value = np.hstack([v**3, 4 - 6 * u**2 + 3 * u**3, 4 - 6 * v**2 + 3 * v**3, u**3]) / 6
        slope = np.hstack([-(v**2), 3 * u**2 - 4 * u, 4 * v - 3 * v**2, u**2]) / 2
        bend = np.hstack([v, 3 * u - 2, 3 * v - 2, u])
        return _states(value @ near, slope @ near / self.dt, bend @ near / self.dt**2)


def _states(value: Array, slope: Array, bend: Array) -> States:
    """Turn curves of quaternions' components into unit quaternions and how fast they turn.

    For p of any length, the angular velocity in the turned frame is 2 Im(p* p') / |p|^2.
    """
    n = len(value)
    p, dp, ddp = (x[:, 3:].reshape(n, -1, 4) for x in (value, slope, bend))
    squares = (p * p).sum(axis=-1, keepdims=True)
    spin = 2 * multiply(inverse(p), dp)[..., 1:] / squares
    spin_up = 2 * multiply(inverse(p), ddp)[..., 1:] / squares
    spin_up -= 2 * (p * dp).sum(axis=-1, keepdims=True) / squares * spin
    return States(
        np.hstack([value[:, :3], (p / np.sqrt(squares)).reshape(n, -1)]),
        np.hstack([slope[:, :3], spin.reshape(n, -1)]),
        np.hstack([bend[:, :3], spin_up.reshape(n, -1)]),
    )


def calmed_target(
    places: Array, rotations: Array, frame_rate: float, smoothing: float
) -> Target:
    """Return the curve of base and joints, calmed by a Gaussian of `smoothing` seconds in all.

    Parameters
    ----------
    places : shape (n_frames, 3), metres
    rotations : shape (n_frames, n_joints, 4)
        Without gaps; the base's are in the world.
    frame_rate : float, hertz
    smoothing : float, seconds
        The spline alone smooths by 0.58 of a frame; the Gaussian is for the rest.
    """
    n_frames = len(places)
    channels = np.hstack([places, unroll(rotations).reshape(n_frames, -1)])
    variance = (smoothing * frame_rate) ** 2 - SPLINE_VARIANCE
    pad = min(int(WIDEST * np.sqrt(max(variance, 0.0))) + 1, n_frames - 1)
    longer = np.pad(channels, ((pad, pad), (0, 0)), mode="reflect", reflect_type="odd")
    if variance > 0.0:
        longer = gaussian_filter1d(longer, np.sqrt(variance), axis=0, mode="nearest")
    calm = longer[pad : pad + n_frames]
    if n_frames == 1:
        return Target(np.repeat(calm, 3, axis=0), 1.0 / frame_rate)
    first, last = 2 * calm[:1] - calm[1:2], 2 * calm[-1:] - calm[-2:-1]
    return Target(np.concatenate([first, calm, last]), 1.0 / frame_rate)


def blended(motion: Motion, other: Motion, joints: Sequence[int], share: Array) -> Motion:
    """Return the motion gone by a share of each frame, 0 to 1, towards another.

    Only the root's place and the rotations of these joints differ; a share of 1 gives the
    other's bits, and one of 0 those of the motion.
    """
    rotations = motion.rotations.copy()
    near, far = rotations[:, list(joints)], other.rotations[:, list(joints)]
    turned = slerp(near, far, np.broadcast_to(share[:, None], near.shape[:2]))
    turned = np.where(share[:, None, None] == 0.0, near, turned)
    rotations[:, list(joints)] = np.where(share[:, None, None] == 1.0, far, turned)
    weight = share[:, None]
    roots = (1 - weight) * motion.root_positions + weight * other.root_positions
    return motion.with_poses(rotations, roots)


def away_from(frames: NDArray[np.bool_], ease: float) -> Array:
    """Return a share that is 0 at these frames and rises to 1 at `ease` frames from them, which
    need not be a whole number.
    """
    # One frame beyond each end, too far to matter: there is always one to measure to.
    far = int(ease) + 2
    clear = np.pad(~frames, far, constant_values=True)
    clear[[0, -1]] = False
    away = distance_transform_edt(clear)[far:-far]
    return np.asarray(np.minimum(1.0, away / ease))


def fill_gaps(motion: Motion) -> Motion:
    """Return the motion without gaps: turned evenly across them, and held at the take's ends.

    A joint that is never observed stays in its rest pose.

    Raises
    ------
    InvalidMotionError
        The root's place is never observed.
    """
    if motion.observed.all():
        return motion
    if not np.isfinite(motion.root_positions).all(axis=-1).any():
        raise InvalidMotionError(
            "The place of the root is never observed, so there is nothing to simulate."
        )
    rotations = bridged_rotations(motion.rotations)
    return motion.with_poses(rotations, bridged(motion.root_positions))
