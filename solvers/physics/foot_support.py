"""Estimate when the feet of a simulated body stand."""

import numpy as np

from ..arrays import Array, Flags
from ..motion import HumanoidMap, Motion, detect_contacts
from ..motion.humanoid import SIDES
from ..signals import smooth_gaussian
from .body import PhysicsBody
from .body_surface import measure_sole_speeds, select_foot_ends

LOAD_SMOOTHING_S = 0.02
"""Standard deviation in seconds of the Gaussian that smooths loads and speeds. Chosen
by hand; `make sensitivity` varies it."""

MIN_LOAD = 0.05
"""Fraction of the weight with which a foot starts to stand. Half and twice are no better
(`make sensitivity`)."""
FULL_LOAD = 0.15
"""Fraction of the weight with which a foot stands. It guards the free leg of an actor who rests
on the other one: higher lets it slip, lower holds a foot that only touches
(`test_foot_of_the_free_leg_stands_and_one_that_touches_moves`)."""

HOLD_SPEED_M_S, RELEASE_SPEED_M_S = 0.3, 0.5
"""Meters per second, for legs of 0.9 m: a loaded sole is held below the first speed and slips
above the second. Chosen by hand; `make sensitivity` varies them."""


def humanoid_of(body: PhysicsBody) -> HumanoidMap:
    """Return the humanoid roles of the joints of a body."""
    return HumanoidMap({role: body.skeleton.names[joint] for joint, role in body.roles.items()})


def detect_target_contacts(body: PhysicsBody, motion: Motion) -> Flags:
    """Return the contacts of a motion's feet, shape (n_frames, 2); none for a body without
    feet."""
    humanoid = humanoid_of(body)
    if not humanoid.has(*(f"{side}Foot" for side in SIDES)):
        return np.zeros((motion.n_frames, len(SIDES)), dtype=np.bool_)
    return detect_contacts(motion, humanoid)


def compute_support_weights(
    body: PhysicsBody, motion: Motion, loads: Array, target_weights: Array
) -> Array:
    """Return weights, 0 to 1, that hold each simulated foot in position.

    A foot stands where the target's does, although the other foot may bear all the weight
    here. It also stands if it carries weight and hardly moves in the simulation.

    Parameters
    ----------
    body : PhysicsBody
    motion : Motion
        As simulated.
    loads : shape (n_frames, n_ends)
        Upward ground force at each end of `PhysicsBody.ground_capsules`, as a fraction of the
        weight.
    target_weights : shape (n_frames, 2), 0 to 1
        1 where a foot of the target stands.

    Returns
    -------
    Array
        Shape (n_frames, 2), left and right.
    """
    speeds = _smooth(measure_sole_speeds(body, motion), motion.frame_rate) / body.size
    slow = np.clip(
        (RELEASE_SPEED_M_S - speeds) / (RELEASE_SPEED_M_S - HOLD_SPEED_M_S), 0.0, 1.0
    )
    load = _smooth(sum_foot_loads(body, loads), motion.frame_rate)
    carries = np.clip((load - MIN_LOAD) / (FULL_LOAD - MIN_LOAD), 0.0, 1.0)
    return np.maximum(carries * slow, target_weights)


def weights_between_frames(weights: Array) -> Array:
    """Return the weights that hold feet between frames, shape (n_frames - 1, 2)."""
    return np.minimum(weights[1:], weights[:-1])


def sum_foot_loads(body: PhysicsBody, loads: Array) -> Array:
    """Return the fraction of the weight that each foot carries, shape (n_frames, 2)."""
    return np.stack(
        [loads[:, select_foot_ends(body, side)].sum(axis=1) for side in SIDES], axis=-1
    )


def _smooth(values: Array, frame_rate: float) -> Array:
    return smooth_gaussian(values, LOAD_SMOOTHING_S * frame_rate)
