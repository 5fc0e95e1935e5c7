"""Keep knees from popping: move heel and hips slightly where the leg is nearly straight."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.ndimage import gaussian_filter1d  # reflects ends; smooth_gaussian repeats them

from ...arrays import Array
from ...motion import WorldPoses
from ...rotations import multiply, quaternion_from_rotation_vector, rotate
from .foot_trajectory import FootTrajectory

UP = np.array([0.0, 0.0, 1.0])
KNEE_WINDOW_S = 0.08
"""Seconds to either side over which the knee flexion is fitted with a parabola. Chosen by hand:
x0.5 costs 3.6 %, x2 costs 0.1 %."""
RELIEF_RAMP_S = 0.03
"""Seconds over which the correction sets in. Chosen by hand: x0.5 costs 0.1 %, x2 costs
nothing."""
MAX_ROOT_OFFSET_M = 0.004
"""Meters by which the root may move: enough for jitter, not for motion. Chosen by hand: x0.5
costs 0.3 %, x2 gains 0.1 %."""
MIN_LEVER_M = 0.03
"""Meters: with a shorter lever, pitching the foot hardly lengthens the leg. Chosen by hand:
x0.5 costs nothing, x2 costs 0.2 %."""
N_ROUNDS = 2
"""Damped Newton steps toward the pitch. Chosen by hand: x0.5 costs 0.7 %, x2 gains 0.3 %."""


def smooth_knees(
    trajectories: Sequence[FootTrajectory], poses: WorldPoses, shift: Array, frame_rate: float
) -> tuple[list[FootTrajectory], Array]:
    """Pitch feet and offset the root so that the knees bend smoothly.

    A nearly straight leg bends by six degrees when it gets a millimeter shorter, so jitter
    between a planted foot and the hips makes the knee pop. That jitter is the knee flexion
    minus a running parabola. While the ball carries the load the heel is free: half a degree
    of pitch about the ball absorbs the same millimeter. What remains is jitter of the hips
    relative to a foot at rest, and is subtracted from the root.

    Parameters
    ----------
    trajectories : sequence of FootTrajectory
    poses : WorldPoses
        Of the original motion.
    shift : shape (n_frames, 3), meters
        Planned offset of the root, and so of the hip.
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
    """Pitch the foot about its ball; return also the leg's direction and its missing length."""
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
    from scipy.signal import savgol_filter  # takes a second to import

    return np.asarray(savgol_filter(flexion, window, 2))


def _flexion_from_distance(distance: Array, thigh: Array, shin: Array) -> Array:
    """Return the knee flexion in radians, 0 straight, for a distance from hip to ankle."""
    cosine = (distance**2 - thigh**2 - shin**2) / np.maximum(2.0 * thigh * shin, 1e-12)
    return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))


def _distance_from_flexion(flexion: Array, thigh: Array, shin: Array) -> Array:
    """Invert `_flexion_from_distance`."""
    return np.asarray(np.sqrt(thigh**2 + shin**2 + 2.0 * thigh * shin * np.cos(flexion)))
