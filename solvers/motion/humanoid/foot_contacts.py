"""Detect foot contacts with the ground."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Flags
from ...errors import InvalidMotionError
from ...signals import (
    DIFFERENCE_GAIN,
    DIFFERENCE_ORDER,
    fill_channel_gaps,
    smooth_gaussian,
    two_state_probabilities,
)
from ..skeletons import Motion, Skeleton, forward_kinematics, ground_level
from .canonical import ball_of_foot
from .roles import HumanoidMap, find_humanoid_map
from .tables import SIDES

HUMAN_LEG_LENGTH_M = 0.9
"""Leg length, hip to ankle, for which the model is defined; it scales with the leg. By
definition."""

MEDIAN_LENGTH = 1.538
"""Ratio of the median length of a vector of three normal numbers to their deviation. By
definition."""

SPEED_NOISE = 0.15
"""Meters per second: noise moves smoothed feet no faster along each axis. Sweep: x0.7 and x1.7
change F1 of noisy captures by less than 0.02 (`test_jitter_changes_little`)."""


@dataclass(frozen=True)
class ContactModel:
    """Hidden Markov model of a foot; lengths and speeds are for a leg of 0.9 m.

    The log odds of contact are `bias` while the slower and lower of ankle and toes rests on the
    ground. They decrease with the logarithm of its speed and height.
    """

    bias: float
    speed_weight: float
    speed: float
    """Meters per second above which speed counts."""
    height_weight: float
    height: float
    """Meters, above which height counts."""
    memory: float
    """Seconds of motion that are one independent observation."""
    landing_rate: float
    """Per second in the air."""
    lift_rate: float
    """Per second on the ground."""


CONTACT_MODEL = ContactModel(
    bias=34.2,
    speed_weight=12.3,
    speed=0.157,
    height_weight=9.11,
    height=0.0116,
    memory=0.703,
    landing_rate=4.43,
    lift_rate=2.43,
)
"""Learned by `tests/training/learn_contacts.py`; meters and seconds, for a leg of 0.9 m."""


def detect_contacts(motion: Motion, humanoid_map: HumanoidMap | None = None) -> Flags:
    """Return when the left and the right foot are in contact with the ground.

    A foot is in contact if its `contact_probabilities` exceed one half.

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
    """Return foot contacts, (n_frames, 2), from positions; see `probabilities_of_points`."""
    return probabilities_of_points(positions, frame_rate, size) > 0.5


def probabilities_of_points(
    positions: Array, frame_rate: float, size: float = 1.0, model: ContactModel = CONTACT_MODEL
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
    """Return the joints of foot contact, shape (2, 2): left and right, ankle and toes.

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
    return known_foot_points(skeleton, humanoid)


def known_foot_points(skeleton: Skeleton, humanoid: HumanoidMap) -> NDArray[np.intp]:
    """Return the rows of `foot_points` whose foot has a role, (n_feet, 2)."""
    joints = humanoid.indices(skeleton)
    rows = []
    for side in SIDES:
        foot = joints.get(f"{side}Foot")
        if foot is not None:
            rows.append([foot, joints.get(f"{side}Toes", ball_of_foot(skeleton, foot))])
    return np.array(rows, dtype=np.intp).reshape(-1, 2)


def leg_length(skeleton: Skeleton, humanoid: HumanoidMap) -> float:
    """Return the mean length of both legs from hip to ankle along the bones, in meters.

    Legs without hip or knee get a length of 0.9 m.
    """
    joints = humanoid.indices(skeleton)
    lengths = []
    for side in SIDES:
        roles = [f"{side}UpperLeg", f"{side}LowerLeg", f"{side}Foot"]
        if all(role in joints for role in roles):
            leg = skeleton.rest_positions[[joints[role] for role in roles]]
            lengths.append(np.linalg.norm(np.diff(leg, axis=0), axis=-1).sum())
    return float(np.mean(lengths)) if lengths and min(lengths) > 0.0 else HUMAN_LEG_LENGTH_M


@dataclass(frozen=True, eq=False)
class FeetInMotion:
    """How fast and how high ankles and toes are, shapes (n_frames, 2 feet, 2 points).

    Attributes
    ----------
    observed : bool
    speeds : meters per second
    heights : meters above the ground
    independence : float, seconds
        Duration in which smoothing leaves one independent sample.
    dt : float, seconds
    """

    observed: Flags
    speeds: Array
    heights: Array
    independence: float
    dt: float

    def evidence(self, model: ContactModel) -> Array:
        """Return the log odds that the frame by itself adds for contact, (n_frames, 2)."""
        speed = (self.speeds / model.speed) ** 2
        height = (np.maximum(self.heights, 0.0) / model.height) ** 2
        log_odds = (
            model.bias
            - model.speed_weight * np.log1p(speed)
            - model.height_weight * np.log1p(height)
        )
        best = np.where(self.observed, log_odds, -np.inf).max(axis=-1)
        best = np.where(self.observed.any(axis=-1), best, 0.0)
        return np.asarray(best * self.dt / (model.memory + self.independence))


def measure_feet(
    positions: Array, frame_rate: float, ground: Array | None = None
) -> FeetInMotion:
    """Smooth feet as much as their noise demands, and measure speeds and heights.

    White noise of deviation s moves what a Gaussian of deviation t smooths at
    s sqrt(dt / (4 sqrt(pi) t^3)) along each axis.

    Parameters
    ----------
    positions : shape (n_frames, 2, 2, 3), meters, for a leg of 0.9 m
        Of feet, or of two points of each hand or knee.
    frame_rate : float, hertz
    ground : shape (n_frames,), meters
        By default where the lower ankle and the lower toes stand.
    """
    dt = 1.0 / frame_rate
    observed = np.isfinite(positions).all(axis=-1)
    noise = foot_noise(positions)
    width = float(np.cbrt(noise**2 * dt / (4.0 * np.sqrt(np.pi)) / SPEED_NOISE**2))
    path = fill_channel_gaps(positions.reshape(len(positions), -1))
    path = smooth_gaussian(path, width * frame_rate).reshape(positions.shape)
    independence = 2.0 * np.sqrt(np.pi) * width
    speed_noise = min(SPEED_NOISE, np.sqrt(2.0) * noise * frame_rate)
    if ground is None:
        own = [
            _above_ground(path[:, :, point, 2], observed[:, :, point].any(axis=0), frame_rate)
            for point in range(2)
        ]
        heights = np.stack(own, axis=-1)
    else:
        heights = path[..., 2] - ground[:, None, None]
    return FeetInMotion(
        observed,
        np.sqrt(np.maximum(_speeds(path, frame_rate) ** 2 - 3.0 * speed_noise**2, 0.0)),
        heights,
        independence,
        dt,
    )


def foot_noise(positions: Array) -> float:
    """Return the standard deviation per axis of white noise in positions (n_frames, ..., 3)."""
    differences = np.linalg.norm(np.diff(positions, DIFFERENCE_ORDER, axis=0), axis=-1)
    known = differences[np.isfinite(differences)]
    return float(np.median(known)) / DIFFERENCE_GAIN / MEDIAN_LENGTH if known.size else 0.0


def _speeds(path: Array, frame_rate: float) -> Array:
    """Return the lower of the speeds before and after each frame, shape of `path` without axes.

    So the first and the last frame of a contact are as slow as those between them.
    """
    if len(path) == 1:
        return np.zeros(path.shape[:-1])
    steps = np.linalg.norm(np.diff(path, axis=0), axis=-1) * frame_rate
    steps = np.pad(steps, ((1, 1), (0, 0), (0, 0)), mode="edge")
    return np.asarray(np.minimum(steps[:-1], steps[1:]))


def _above_ground(heights: Array, observed: Flags, frame_rate: float) -> Array:
    """Return the heights of both ankles (or toes) above the ground, shape (n_frames, 2)."""
    if not observed.any():
        return heights
    ground = ground_level(heights[:, observed].min(axis=1), frame_rate)
    return np.asarray(heights - ground[:, None])
