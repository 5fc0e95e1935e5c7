"""Detect foot contacts with the ground."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Flags
from ...errors import InvalidMotionError
from ...signals import two_state_probabilities
from ..skeletons import Motion, Skeleton, forward_kinematics
from .contact_model import LEARNED, ContactModel, measure_feet
from .roles import HumanoidMap, find_humanoid_map

HUMAN_LEG_LENGTH_M = 0.9
"""Leg length, hip to ankle, for which the model is defined; it scales with the leg. By
definition."""


def detect_contacts(motion: Motion, humanoid_map: HumanoidMap | None = None) -> Flags:
    """Return when the left and the right foot are in contact with the ground.

    A foot is in contact if `contact_probabilities` says so with more than one half.

    Parameters
    ----------
    motion : Motion
    humanoid_map : HumanoidMap, optional
        By default from `find_humanoid_map`.

    Returns
    -------
    NDArray of bool, shape (n_frames, 2)
        Left foot, right foot. False where the foot is missing.

    Raises
    ------
    InvalidMotionError
        The skeleton does not have two feet.
    """
    return contact_probabilities(motion, humanoid_map) > 0.5


def contact_probabilities(motion: Motion, humanoid_map: HumanoidMap | None = None) -> Array:
    """Return the probability that the left and the right foot are in contact with the ground.

    A hidden Markov model sees how fast ankle and toes are, and how high above the ground. The
    ground is the highest level on which the lower foot stands within a second, so that it may
    slope or have steps.

    Parameters
    ----------
    motion : Motion
    humanoid_map : HumanoidMap, optional
        By default from `find_humanoid_map`.

    Returns
    -------
    Array, shape (n_frames, 2)
        Left foot, right foot. 0 where the foot is missing.

    Raises
    ------
    InvalidMotionError
        The skeleton does not have two feet.
    """
    humanoid = humanoid_map or find_humanoid_map(motion.skeleton)
    feet = foot_points(motion.skeleton, humanoid)
    positions = forward_kinematics(motion).positions[:, feet]
    size = leg_length(motion.skeleton, humanoid) / HUMAN_LEG_LENGTH_M
    return probabilities_of_points(positions, motion.frame_rate, size)


def contacts_of_points(positions: Array, frame_rate: float, size: float = 1.0) -> Flags:
    """Return foot contacts from positions alone; see `probabilities_of_points`."""
    return probabilities_of_points(positions, frame_rate, size) > 0.5


def probabilities_of_points(
    positions: Array, frame_rate: float, size: float = 1.0, model: ContactModel = LEARNED
) -> Array:
    """Return the probability of foot contact from positions alone; see `contact_probabilities`.

    Parameters
    ----------
    positions : shape (n_frames, 2, 2, 3), meters
        Left and right, ankle and toes (the same point twice if there is only one).
    frame_rate : float, hertz
    size : float
        Length of a leg over 0.9 m.
    model : ContactModel

    Returns
    -------
    Array, shape (n_frames, 2)
        Left foot, right foot. 0 where the foot is missing.
    """
    feet = measure_feet(positions / size, frame_rate)
    probability = two_state_probabilities(
        feet.evidence(model), frame_rate, model.landing_rate, model.lift_rate
    )
    return np.where(feet.observed.any(axis=-1), probability, 0.0)


def foot_points(skeleton: Skeleton, humanoid: HumanoidMap) -> NDArray[np.intp]:
    """Return the joints of foot contact: rows left and right, columns ankle and toes.

    Without a toe joint, the end site of the foot replaces it, or else the ankle.

    Raises
    ------
    InvalidMotionError
        A foot is missing.
    """
    joints = humanoid.indices(skeleton)
    missing = [role for role in ("leftFoot", "rightFoot") if role not in joints]
    if missing:
        raise InvalidMotionError(
            f"No joint has the humanoid role {' or '.join(missing)}. Choose one in the map."
        )
    rows = []
    for side in ("left", "right"):
        foot = joints[f"{side}Foot"]
        rows.append([foot, joints.get(f"{side}Toes", (*skeleton.children[foot], foot)[0])])
    return np.array(rows)


def leg_length(skeleton: Skeleton, humanoid: HumanoidMap) -> float:
    """Return the mean length of both legs from hip to ankle along the bones, in meters.

    Legs without hip or knee get a length of 0.9 m.
    """
    joints = humanoid.indices(skeleton)
    lengths = []
    for side in ("left", "right"):
        roles = [f"{side}UpperLeg", f"{side}LowerLeg", f"{side}Foot"]
        if all(role in joints for role in roles):
            leg = skeleton.rest_positions[[joints[role] for role in roles]]
            lengths.append(np.linalg.norm(np.diff(leg, axis=0), axis=-1).sum())
    return float(np.mean(lengths)) if lengths and min(lengths) > 0.0 else HUMAN_LEG_LENGTH_M
