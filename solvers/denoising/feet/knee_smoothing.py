"""Keep knees from popping: let heel and hips give way where the leg is nearly straight."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ...motion import WorldPoses
from ...rotations import multiply, quaternion_from_rotation_vector, rotate
from .foot_trajectory import Plant

Array = NDArray[np.float64]

UP = np.array([0.0, 0.0, 1.0])
CALM = 0.08
"""Seconds to either side over which a knee should bend like a parabola."""
EDGE = 0.03
"""Seconds over which relief sets in."""
MOST_PITCH = np.radians(6.0)
MOST_SHIFT = 0.004
"""Metres by which the root may give way: trembling, not motion."""
SHORT_LEVER = 0.03
"""Metres: a foot that turns about less lever hardly lengthens the leg."""
N_ROUNDS = 2


def knee_relief(
    plants: Sequence[Plant], poses: WorldPoses, shift: Array, frame_rate: float
) -> tuple[list[Plant], Array]:
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
    relieved = []
    normal = np.zeros((len(shift), 3, 3)) + 0.1 * np.eye(3)
    wish = np.zeros_like(shift)
    for plant in plants:
        plant, along, lacking = _pitched(plant, poses, shift, frame_rate)
        relieved.append(plant)
        weight = gaussian_filter1d(plant.contact.astype(float), EDGE * frame_rate)
        weight *= plant.contact
        normal += weight[:, None, None] * along[:, :, None] * along[:, None, :]
        tremble = MOST_SHIFT * np.tanh(lacking / MOST_SHIFT)
        wish -= (weight * tremble)[:, None] * along
    return relieved, shift + np.linalg.solve(normal, wish[..., None])[..., 0]


def _pitched(
    plant: Plant, poses: WorldPoses, shift: Array, frame_rate: float
) -> tuple[Plant, Array, Array]:
    """Pitch the foot about its ball; return also the leg's direction and what it lacks."""
    hip, knee, ankle = (poses.positions[:, joint] for joint in plant.leg.chain)
    thigh, shin = np.linalg.norm(knee - hip, axis=1), np.linalg.norm(ankle - knee, axis=1)
    way = plant.ankle - hip - shift
    bend = _bend(np.linalg.norm(way, axis=1), thigh, shin)
    wanted = _reach(np.maximum(_calmed(bend, frame_rate), 0.0), thigh, shin)
    heel_free = plant.contact * np.clip(1.0 - 3.0 * plant.load[:, 0], 0.0, 1.0)
    heel_free = gaussian_filter1d(heel_free, EDGE * frame_rate)
    for _ in range(N_ROUNDS):
        distance = np.linalg.norm(plant.ankle - hip - shift, axis=1)
        along = (plant.ankle - hip - shift) / np.maximum(distance, 1e-9)[:, None]
        to_ball = plant.arms[:, 1]
        across = np.cross(UP, to_ball - plant.arms[:, 0])
        across /= np.maximum(np.linalg.norm(across, axis=1), 1e-9)[:, None]
        lever = np.einsum("fi,fi->f", np.cross(across, -to_ball), along)
        angle = heel_free * (wanted - distance) * lever / (lever**2 + SHORT_LEVER**2)
        angle = MOST_PITCH * np.tanh(angle / MOST_PITCH)
        pitch = quaternion_from_rotation_vector(angle[:, None] * across)
        plant = replace(
            plant,
            turn=multiply(pitch, plant.turn),
            ankle=plant.ankle + to_ball - rotate(pitch, to_ball),
            arms=rotate(pitch[:, None], plant.arms),
        )
    way = plant.ankle - hip - shift
    distance = np.linalg.norm(way, axis=1)
    return plant, way / np.maximum(distance, 1e-9)[:, None], wanted - distance


def _calmed(bend: Array, frame_rate: float) -> Array:
    window = 2 * round(CALM * frame_rate) + 1
    if window < 5 or len(bend) < window:
        return bend
    from scipy.signal import savgol_filter  # takes a second to import: not before it is needed

    return np.asarray(savgol_filter(bend, window, 2))


def _bend(distance: Array, thigh: Array, shin: Array) -> Array:
    """Return the knee's flexion in radians, 0 straight, for a distance of hip and ankle."""
    cosine = (distance**2 - thigh**2 - shin**2) / np.maximum(2.0 * thigh * shin, 1e-12)
    return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))


def _reach(bend: Array, thigh: Array, shin: Array) -> Array:
    """Undo `_bend`."""
    return np.asarray(np.sqrt(thigh**2 + shin**2 + 2.0 * thigh * shin * np.cos(bend)))
