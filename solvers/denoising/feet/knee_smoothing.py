"""Keep knees from popping: let heel and hips give way where the leg is nearly straight."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ...motion import WorldPoses
from ...rotations import multiply, quaternion_from_rotation_vector, rotate
from .foot_trajectory import FootTrajectory

Array = NDArray[np.float64]

UP = np.array([0.0, 0.0, 1.0])
KNEE_WINDOW_S = 0.08
"""Seconds to either side over which a knee should bend like a parabola."""
RELIEF_RAMP_S = 0.03
"""Seconds over which relief sets in."""
MAX_PITCH = np.radians(6.0)
MAX_ROOT_OFFSET_M = 0.004
"""Metres by which the root may give way: trembling, not motion."""
MIN_LEVER_M = 0.03
"""Metres: a foot that turns about less lever hardly lengthens the leg."""
N_ROUNDS = 2


def smooth_knees(
    trajectories: Sequence[FootTrajectory], poses: WorldPoses, shift: Array, frame_rate: float
) -> tuple[list[FootTrajectory], Array]:
    """Return plants with pitched feet, and a root shift, that let the knees bend smoothly.

    A leg that is nearly straight bends by six degrees when it gets a millimetre shorter, so
    that whatever trembles between a still foot and the hips becomes a knee that pops. What
    remains of the knee's bend when a running parabola is taken away is that tremble. While
    the ball carries the load the heel is free: half a degree of pitch about the ball takes up
    the same millimetre. What is left is the trembling of the hips, seen from a foot at rest,
    and is taken from the root.

    Parameters
    ----------
    plants : sequence of Plant
    poses : WorldPoses
        Of the original motion.
    shift : shape (n_frames, 3), metres
        By which the root, and so the hip, will be moved.
    frame_rate : float, hertz
    """
    smoothed = []
    normal = np.zeros((len(shift), 3, 3)) + 0.1 * np.eye(3)
    weighted_offset = np.zeros_like(shift)
    for trajectory in trajectories:
        trajectory, along, missing_reach = _pitch_foot(trajectory, poses, shift, frame_rate)
        smoothed.append(trajectory)
        weight = gaussian_filter1d(trajectory.contact.astype(float), RELIEF_RAMP_S * frame_rate)
        weight *= trajectory.contact
        normal += weight[:, None, None] * along[:, :, None] * along[:, None, :]
        offset = MAX_ROOT_OFFSET_M * np.tanh(missing_reach / MAX_ROOT_OFFSET_M)
        weighted_offset -= (weight * offset)[:, None] * along
    return smoothed, shift + np.linalg.solve(normal, weighted_offset[..., None])[..., 0]


def _pitch_foot(
    trajectory: FootTrajectory, poses: WorldPoses, shift: Array, frame_rate: float
) -> tuple[FootTrajectory, Array, Array]:
    """Pitch the foot about its ball; return also the leg's direction and what it lacks."""
    hip, knee, ankle = (poses.positions[:, joint] for joint in trajectory.leg.chain)
    thigh, shin = np.linalg.norm(knee - hip, axis=1), np.linalg.norm(ankle - knee, axis=1)
    hip_to_ankle = trajectory.ankle - hip - shift
    flexion = _flexion_from_distance(np.linalg.norm(hip_to_ankle, axis=1), thigh, shin)
    target_distance = _distance_from_flexion(
        np.maximum(_smooth_flexion(flexion, frame_rate), 0.0), thigh, shin
    )
    heel_free = trajectory.contact * np.clip(1.0 - 3.0 * trajectory.load[:, 0], 0.0, 1.0)
    heel_free = gaussian_filter1d(heel_free, RELIEF_RAMP_S * frame_rate)
    for _ in range(N_ROUNDS):
        distance = np.linalg.norm(trajectory.ankle - hip - shift, axis=1)
        along = (trajectory.ankle - hip - shift) / np.maximum(distance, 1e-9)[:, None]
        to_ball = trajectory.sole_offsets[:, 1]
        across = np.cross(UP, to_ball - trajectory.sole_offsets[:, 0])
        across /= np.maximum(np.linalg.norm(across, axis=1), 1e-9)[:, None]
        lever = np.einsum("fi,fi->f", np.cross(across, -to_ball), along)
        angle = heel_free * (target_distance - distance) * lever / (lever**2 + MIN_LEVER_M**2)
        angle = MAX_PITCH * np.tanh(angle / MAX_PITCH)
        pitch = quaternion_from_rotation_vector(angle[:, None] * across)
        trajectory = replace(
            trajectory,
            foot_rotation=multiply(pitch, trajectory.foot_rotation),
            ankle=trajectory.ankle + to_ball - rotate(pitch, to_ball),
            sole_offsets=rotate(pitch[:, None], trajectory.sole_offsets),
        )
    hip_to_ankle = trajectory.ankle - hip - shift
    distance = np.linalg.norm(hip_to_ankle, axis=1)
    return (
        trajectory,
        hip_to_ankle / np.maximum(distance, 1e-9)[:, None],
        target_distance - distance,
    )


def _smooth_flexion(flexion: Array, frame_rate: float) -> Array:
    window = 2 * round(KNEE_WINDOW_S * frame_rate) + 1
    if window < 5 or len(flexion) < window:
        return flexion
    from scipy.signal import savgol_filter  # takes a second to import: not before it is needed

    return np.asarray(savgol_filter(flexion, window, 2))


def _flexion_from_distance(distance: Array, thigh: Array, shin: Array) -> Array:
    """Return the knee's flexion in radians, 0 straight, for a distance of hip and ankle."""
    cosine = (distance**2 - thigh**2 - shin**2) / np.maximum(2.0 * thigh * shin, 1e-12)
    return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))


def _distance_from_flexion(flexion: Array, thigh: Array, shin: Array) -> Array:
    """Undo `_bend`."""
    return np.asarray(np.sqrt(thigh**2 + shin**2 + 2.0 * thigh * shin * np.cos(flexion)))
